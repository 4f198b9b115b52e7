// How far a camera's motion carries a point of the picture. In: two views, a pixel and its depth; out: pixels.
#pragma once

#include "common/camera.h"

namespace framelet {

/// Distance in pixels between where the point is seen by the two views (of one viewport). `inverse_depth`: 1 / view
/// depth in the first view, 0 for what is infinitely far. A point behind the second camera counts as gone:
/// `most_pixels`, which no answer exceeds.
float view_displacement(ViewRays const& from, ViewRays const& to, Vec2 pixel, float inverse_depth, float most_pixels);

} // namespace framelet
