#include "tests/evaluation/methods/warp_viewer.h"

namespace framelet::bench {

WarpViewer::WarpViewer(Viewport viewport, CostTable const& costs)
    : costs_(costs), cache_(ImagePlane(viewport)), picture_(viewport.width, viewport.height) {}

ViewerStep WarpViewer::insert(Batch const& batch) {
    cache_.insert(batch);
    for (BodyTrack const& track : batch.tracks) {
        motions_.extend(track);
    }
    ViewerStep step;
    step.seconds.decode = 1e-9 * static_cast<double>(batch.framelets.size() * framelet_samples) * costs_.cache_sample;
    return step;
}

ViewerStep WarpViewer::present(Camera const& camera, SceneTime time) {
    cache_.take_changed(changed_);
    reprojector_.show(cache_, changed_, camera, time, motions_, picture_, repainted_);
    double pixels = 0;
    for (PixelRect const& rect : repainted_) {
        pixels += static_cast<double>(rect.width()) * rect.height();
    }
    ViewerStep step;
    step.seconds.reconstruct =
        1e-9 * pixels * (reprojector_.is_exact() ? costs_.reconstruct_pixel : costs_.reproject_pixel);
    return step;
}

} // namespace framelet::bench
