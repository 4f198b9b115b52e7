#include "tests/evaluation/methods/warp_viewer.h"

#include <utility>

#include "common/picture/reconstruction.h"

namespace framelet::bench {

WarpViewer::WarpViewer(Viewport viewport, CostTable const& costs, PictureSettings const& settings, SessionTimes* times)
    : costs_(costs), settings_(settings), times_(times), maker_(viewport, settings),
      picture_(viewport.width, viewport.height) {
    reconstruct_all(maker_.pool().newest(), picture_); // a picture without framelets
}

ViewerStep WarpViewer::insert(Batch const& batch) {
    clocked(times_, &SessionTimes::insert, [&] { maker_.insert(batch); });
    ImagePlane const plane(batch.view.viewport);
    for (DisplayFramelet const& framelet : batch.framelets) {
        fine_samples_ += plane.sample_spacing(framelet.tile) < 1 ? framelet_samples : 0;
    }
    ViewerStep step;
    step.seconds.decode = charged(times_, &SessionTimes::insert,
                                  1e-9 * static_cast<double>(batch.framelets.size() * framelet_samples) *
                                      costs_.cache_sample * (maker_.is_smooth() ? 2 : 1));
    return step;
}

void WarpViewer::take_evicted(std::vector<SentTile>& framelets) {
    maker_.take_evicted(evicted_);
    framelets.insert(framelets.end(), evicted_.begin(), evicted_.end());
}

ViewerStep WarpViewer::present(Camera const& camera, SceneTime time, int scene_camera, bool is_settled) {
    clocked(times_, &SessionTimes::paint, [&] {
        maker_.show({camera, 0, scene_camera, time, 1, time, is_settled}, picture_, changed_);
    });
    double pixels = 0;
    for (PixelRect const& rect : changed_) {
        pixels += static_cast<double>(rect.width()) * rect.height();
    }
    bool const exact = maker_.is_exact();
    double const pixel = exact ? costs_.reconstruct_pixel : (maker_.is_smooth() ? 2 : 1) * costs_.reproject_pixel;
    double const fine = std::exchange(fine_samples_, 0);
    ViewerStep step;
    step.seconds.reconstruct = charged(times_, &SessionTimes::paint,
                                       1e-9 * (pixels * pixel + (exact ? fine * costs_.reconstruct_fine_sample : 0)));
    return step;
}

} // namespace framelet::bench
