// How fast what surfaces look like changes where they are: a shadow passes, a light goes out. In: what a mirror shows
// of a moment, and new pieces of the very same surfaces. Out: how soon the new ones fade. Motion is no change,
// the mirror has moved what it holds; but some change is expected of what turns, and of outlines and reflections before
// a camera that moves.
#pragma once

#include <cstdint>
#include <span>

#include "server/sampling/mirror/mirror.h"

namespace framelet {

/// Compares the pieces of a framelet, of the moment that `mirror` looks at, with what it shows there; sets their
/// `change` and `fading`. Those of another moment (`comparable` false), and what has just come into view, are taken for
/// what does not change: where that is wrong probes find it. `has_outline`: the framelet shows more than one surface;
/// then it is expected to change before a camera that moves, as what turns or reflects is; unless nothing is expected
/// that was not seen. Returns the code of their fading.
FadingCode learn_fading(Mirror const& mirror, std::span<Piece> pieces, SceneTime scene_time, bool comparable,
                        bool has_outline, bool expects_change = true);

} // namespace framelet
