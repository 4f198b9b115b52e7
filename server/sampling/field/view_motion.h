// Finds where a camera's motion carries a point of the picture. In: two views, a pixel and its depth. Out: pixels.
#pragma once

#include <optional>

#include "common/camera.h"

namespace framelet {

/// The pixel at which the second view (of the same viewport) sees what the first one sees at `pixel`; nothing where
/// that is behind the second camera. `inverse_depth`: 1 / view depth in the first view, 0 for what is infinitely far.
/// Finite for finite views.
std::optional<Vec2> moved_pixel(ViewRays const& from, ViewRays const& to, Vec2 pixel, float inverse_depth);

/// Distance, pixels, from `pixel` to `moved_pixel`. What is behind the second camera counts as gone: `most_pixels`,
/// which no answer exceeds.
float view_displacement(ViewRays const& from, ViewRays const& to, Vec2 pixel, float inverse_depth, float most_pixels);

} // namespace framelet
