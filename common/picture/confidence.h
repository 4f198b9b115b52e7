// Finds how far each pixel of a moved picture is to be trusted: how old what it shows is, how coarse, or whether it is
// made up. In: pool, display camera and time, motions of bodies. Out: a picture of that.
#pragma once

#include <vector>

#include "common/framelet/body_motion.h"
#include "common/held/framelet_pool.h"

namespace framelet {

/// Age and spacing of what a pixel shows.
struct PixelConfidence {
    static constexpr float made_up = -1; ///< seconds of a hole, which is filled from what is around it

    float seconds = made_up; ///< of scene time since it was rendered, >= 0
    float spacing = 0; ///< of its samples, pixels of the picture that it was rendered for; 0 in a hole
};

/// Replaces `out` by every pixel of the viewport, in rows, as `Reprojector::show` would show it if the camera
/// has not cut. Takes about as long as showing the whole picture anew; for looking at it, not for every picture.
void find_confidence(FrameletPool const& pool, Camera const& camera, SceneTime scene_time, BodyMotions const& motions,
                     std::vector<PixelConfidence>& out);

} // namespace framelet
