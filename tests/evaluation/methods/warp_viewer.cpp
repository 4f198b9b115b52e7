#include "tests/evaluation/methods/warp_viewer.h"

#include <algorithm>
#include <span>

#include "common/reconstruction.h"

namespace framelet::bench {
namespace {

ViewerStep drawing(std::span<PixelRect const> rects, double pixel_nanoseconds) {
    double pixels = 0;
    for (PixelRect const& rect : rects) {
        pixels += static_cast<double>(rect.width()) * rect.height();
    }
    ViewerStep step;
    step.seconds.reconstruct = 1e-9 * pixels * pixel_nanoseconds;
    return step;
}

} // namespace

WarpViewer::WarpViewer(Viewport viewport, CostTable const& costs, double lag_seconds)
    : costs_(costs), cache_(ImagePlane(viewport)), lag_seconds_(lag_seconds),
      picture_(viewport.width, viewport.height) {
    if (lag_seconds > 0) {
        smoother_.emplace(ImagePlane(viewport));
    }
}

ViewerStep WarpViewer::insert(Batch const& batch) {
    cache_.insert(batch);
    if (smoother_) {
        smoother_->insert(batch);
    }
    for (BodyTrack const& track : batch.tracks) {
        motions_.extend(track);
    }
    ViewerStep step;
    step.seconds.decode = 1e-9 * static_cast<double>(batch.framelets.size() * framelet_samples) * costs_.cache_sample *
                          (smoother_ ? 2 : 1);
    return step;
}

ViewerStep WarpViewer::present(Camera const& camera, SceneTime time) {
    cache_.take_changed(changed_);
    if (smoother_) {
        SceneTime const shown = std::max(0.0, time - lag_seconds_);
        smoother_->show(cache_, changed_, camera, shown, lag_seconds_, motions_, picture_, repainted_);
        return drawing(repainted_, 2 * costs_.reproject_pixel);
    }
    reprojector_.show(cache_, changed_, camera, time, motions_, picture_, repainted_);
    return drawing(repainted_, reprojector_.is_exact() ? costs_.reconstruct_pixel : costs_.reproject_pixel);
}

ViewerStep WarpViewer::present_unmoved() {
    cache_.take_changed(changed_);
    reconstruct(cache_, changed_, picture_);
    return drawing(changed_, costs_.reconstruct_pixel);
}

} // namespace framelet::bench
