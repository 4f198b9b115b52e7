// Where a camera of the scene is at any scene time, from its track. In: keys at a fixed rate, a time. Out: the camera.
#pragma once

#include "common/camera.h"
#include "common/framelet/body_track.h"
#include "common/framelet/framelet.h"

namespace framelet {

/// Position and orientation as `pose_at` gives them, but never between two keys among which the camera has been cut:
/// there it stays at the key before. A cut is a step or a turn several times those before and behind it. The lens is
/// that of `like`.
Camera camera_at(BodyTrack const& track, SceneTime time, Camera const& like);

} // namespace framelet
