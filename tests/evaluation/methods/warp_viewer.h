// The viewer's half of methods that move what they hold to the camera and the scene time of the moment: the project's
// own cache and reprojection. In: batches with shapes and tracks. Out: the picture.
#pragma once

#include <vector>

#include "common/framelet_cache.h"
#include "common/image.h"
#include "common/reprojector.h"
#include "tests/evaluation/method.h"

namespace framelet::bench {

class WarpViewer {
public:
    WarpViewer(Viewport viewport, CostTable const& costs);

    /// Returns what putting it into the cache costs; the picture stays as it is.
    ViewerStep insert(Batch const& batch);
    /// Draws anew what has changed since the last time.
    ViewerStep present(Camera const& camera, SceneTime time);

    Picture const& picture() const { return picture_; }

private:
    CostTable const costs_;
    FrameletCache cache_;
    BodyMotions motions_;
    Reprojector reprojector_;
    std::vector<PixelRect> changed_, repainted_;
    Picture picture_;
};

} // namespace framelet::bench
