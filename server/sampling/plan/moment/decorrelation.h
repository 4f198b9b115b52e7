// Estimates how soon what a framelet shows is expected to fade. Motion is no change, since the viewer moves what it
// holds; but what turns looks otherwise in the light, and so do outlines and reflections before a camera that moves.
// Other changes, such as a shadow that passes, are found by probes. In: the pieces of a framelet. Out: how soon they
// fade.
#pragma once

#include <span>

#include "common/framelet/sample_worth.h"
#include "server/sampling/mirror/piece.h"

namespace framelet {

/// Sets the pieces' `decorrelation` and returns its code. `camera_stands`: it does not move; `has_outline`: the
/// framelet shows more than one surface.
DecorrelationCode expect_decorrelation(std::span<Piece> pieces, bool camera_stands, bool has_outline);

} // namespace framelet
