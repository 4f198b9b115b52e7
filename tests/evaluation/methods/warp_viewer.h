// The viewer's half of methods that send framelets: the client's own picture maker, and its costs. In: batches. Out:
// the picture, moved to the camera and the scene time of the moment or not.
#pragma once

#include <vector>

#include "client/core/picture/picture_maker.h"
#include "tests/evaluation/method.h"

namespace framelet::bench {

class WarpViewer {
public:
    /// `times`: as in MethodSetup.
    WarpViewer(Viewport viewport, CostTable const& costs, PictureSettings const& settings = {},
               SessionTimes* times = nullptr);

    /// Puts the batch into the cache and returns the cost of that; the picture stays as it is.
    ViewerStep insert(Batch const& batch);
    /// Draws anew what differs from the last time. `scene_camera` >= 0: for that camera of the scene along its track,
    /// and not for `camera`. `is_settled`: as in PictureRequest.
    ViewerStep present(Camera const& camera, SceneTime time, int scene_camera = -1, bool is_settled = false);

    /// Appends the framelets that the viewer has evicted since the last call.
    void take_evicted(std::vector<SentTile>& framelets);

    Picture const& picture() const { return picture_; }

private:
    CostTable const costs_;
    PictureSettings const settings_;
    SessionTimes* const times_;
    PictureMaker maker_;
    std::vector<PixelRect> changed_;
    std::vector<SentTile> evicted_; ///< scratch of `take_evicted`
    /// Samples finer than pixels that have come since the last picture.
    double fine_samples_ = 0;
    Picture picture_;
};

} // namespace framelet::bench
