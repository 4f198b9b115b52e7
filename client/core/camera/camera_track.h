// The position of a camera of the scene at any scene time, from its track. In: keys at a fixed rate, a time. Out: the
// camera.
#pragma once

#include "common/camera.h"
#include "common/framelet/body_track.h"
#include "common/framelet/framelet.h"

namespace framelet {

/// The camera with position and orientation as `pose_at` gives them, but never between two keys between which the
/// camera was cut: there it stays at the key before. A cut is a step or a turn several times as large as those before
/// and after it. The lens is that of `like`.
Camera camera_at(BodyTrack const& track, SceneTime time, Camera const& like);

} // namespace framelet
