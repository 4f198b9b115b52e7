// Where a camera's motion carries a point of the picture. In: two views, a pixel and its depth; out: pixels.
#pragma once

#include <optional>

#include "common/camera.h"

namespace framelet {

/// Where the second view (of the same viewport) sees what the first one sees at a pixel; nothing where that is behind
/// the second camera. `inverse_depth`: 1 / view depth in the first view, 0 for what is infinitely far. Finite for
/// finite views.
std::optional<Vec2> moved_pixel(ViewRays const& from, ViewRays const& to, Vec2 pixel, float inverse_depth);

/// How far that is from the pixel. What is behind the second camera counts as gone: `most_pixels`, which no answer
/// exceeds.
float view_displacement(ViewRays const& from, ViewRays const& to, Vec2 pixel, float inverse_depth, float most_pixels);

} // namespace framelet
