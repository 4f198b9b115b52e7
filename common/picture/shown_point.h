// Finds what point of the world a pixel of the picture shows, and how deep all pixels are. In: pool, display camera and
// time, motions of bodies, a position in the picture. Out: the point, where one is known; depths.
#pragma once

#include <optional>
#include <vector>

#include "common/framelet/body_motion.h"
#include "common/held/framelet_pool.h"

namespace framelet {

/// The point that shows at `position` (pixel coordinates) of the picture that `Reprojector::show` would show if the
/// camera has not cut. In a hole it is what its nearest neighbour shows, a few pixels away at most. Nothing outside of
/// the picture, where nothing is held, and where what shows is infinitely far. Plans the whole picture: for a click,
/// not for every picture.
std::optional<Vec3> find_shown_point(FrameletPool const& pool, Camera const& camera, SceneTime scene_time,
                                     BodyMotions const& motions, Vec2 position);

/// The depths of all pixels of such a picture, metres along the camera's forward axis; infinite where what shows is
/// infinitely far, 0 where it is not known. Empty where nothing is known to be at a finite depth: nothing is held, all
/// is infinitely far, or the framelets came without shapes, as for a viewer that moves nothing or looks through an
/// orthographic camera.
std::vector<float> find_shown_depths(FrameletPool const& pool, Camera const& camera, SceneTime scene_time,
                                     BodyMotions const& motions);

} // namespace framelet
