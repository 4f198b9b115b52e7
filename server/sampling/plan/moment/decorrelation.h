// Estimates how soon what a framelet shows is expected to fade once something has moved. Motion is no change, since the
// viewer moves what it holds; but what a body carries comes into other light, and outlines and reflections change
// before a camera that moves. Other changes, such as a shadow that passes, are found by probes. In: the pieces of a
// framelet. Out: how soon they fade.
#pragma once

#include <span>

#include "common/framelet/sample_worth.h"
#include "server/sampling/mirror/piece.h"

namespace framelet {

/// Sets the pieces' `decorrelation` and returns its code. What is on a body gets one also while that rests: what has
/// not moved since it was rendered does not wear. `camera_stands`: it does not move; `has_outline`: the
/// framelet shows more than one surface.
DecorrelationCode expect_decorrelation(std::span<Piece> pieces, bool camera_stands, bool has_outline);

} // namespace framelet
