// What point of the world a pixel of the picture shows, and how deep all pixels are. In: pool, display camera and time,
// motions of bodies, a place in the picture. Out: the point, where one is known; depths.
#pragma once

#include <optional>
#include <vector>

#include "common/framelet/body_motion.h"
#include "common/held/framelet_pool.h"

namespace framelet {

/// Of the picture as `Reprojector::show` would show it if the camera has not cut. `place`: pixel coordinates. In a hole
/// it is what its nearest neighbour shows, a few pixels away at most. Nothing outside of the picture, where nothing is
/// held, and where what shows is infinitely far. Plans the whole picture: for a click, not for every picture.
std::optional<Vec3> find_shown_point(FrameletPool const& pool, Camera const& camera, SceneTime scene_time,
                                     BodyMotions const& motions, Vec2 place);

/// Metres along the camera's forward axis, a number for each pixel of such a picture; infinite where what shows is
/// infinitely far, 0 where it is not known. Empty where it is known nowhere: nothing is held, or the viewer was sent no
/// shapes, as one that moves nothing or looks through an orthographic camera.
std::vector<float> find_shown_depths(FrameletPool const& pool, Camera const& camera, SceneTime scene_time,
                                     BodyMotions const& motions);

} // namespace framelet
