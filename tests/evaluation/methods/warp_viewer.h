// The viewer's half of methods that send framelets: the project's own cache, reconstruction and reprojection. In:
// batches. Out: the picture, moved to the camera and the scene time of the moment or not.
#pragma once

#include <optional>
#include <vector>

#include "common/framelet_cache.h"
#include "common/image.h"
#include "common/reprojector.h"
#include "common/scene_smoother.h"
#include "tests/evaluation/method.h"

namespace framelet::bench {

class WarpViewer {
public:
    /// `lag_seconds` > 0: shows the scene so late, smoothly; the camera it is given is that of the moment.
    WarpViewer(Viewport viewport, CostTable const& costs, double lag_seconds = 0);

    /// Returns what putting it into the cache costs; the picture stays as it is.
    ViewerStep insert(Batch const& batch);
    /// Draws anew what has changed since the last time: all moved to where it is, or left where it was rendered. One
    /// viewer is asked for one or the other.
    ViewerStep present(Camera const& camera, SceneTime time);
    ViewerStep present_unmoved();

    Picture const& picture() const { return picture_; }

private:
    CostTable const costs_;
    FrameletCache cache_;
    BodyMotions motions_;
    Reprojector reprojector_;
    double const lag_seconds_;
    std::optional<SceneSmoother> smoother_;
    std::vector<PixelRect> changed_, repainted_;
    Picture picture_;
};

} // namespace framelet::bench
