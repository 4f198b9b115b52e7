#include "server/stream/batch_work.h"

#include <algorithm>
#include <atomic>

#include <tbb/parallel_for.h>

#include "server/render/display_renderer.h"
#include "server/render/visibility.h"

namespace framelet {

void BatchWork::render(PosedScene const& scene) {
    std::size_t const count = order.plan.tiles.size();
    rendered_pool_.resize(std::max(rendered_pool_.size(), count));
    display_pool_.resize(std::max(display_pool_.size(), count));
    rendered_ = std::span(rendered_pool_).first(count);
    display_ = std::span(display_pool_).first(count);
    NumberedView const& view = order.state.view;
    ImagePlane const plane(view.viewport);
    ViewRays const rays = make_view_rays(view.camera, view.viewport);
    fresh_.prepare();
    std::atomic<std::uint64_t> segments = 0;
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        segments.fetch_add(render_display(scene.render_scene(), rays, plane, order.plan.tiles[i], order.state.exposure,
                                          order.plan.rays_per_sample, order.plan.is_mirrored, fresh_.local(),
                                          rendered_[i], display_[i]),
                           std::memory_order_relaxed);
    });
    if (order.plan.checks && order.plan.checks->visibility) {
        segments +=
            render_visibility(scene.render_scene(), rays, view.viewport, *order.plan.checks->visibility, visibility_);
    }
    figures.segments = segments;
    figures.probe_segments =
        probes_.render(scene.render_scene(), view.camera, view.viewport, order.state.exposure, order.plan.probes);
}

bool BatchWork::learn(PosedScene const& scene, ViewerKnowledge& viewer) {
    if (order.plan.checks && order.plan.checks->visibility) {
        viewer.refresh.note_visibility(order.plan, visibility_);
    }
    if (order.again) {
        needed_.assign(display_.size(), 1);
    } else {
        needed_ = viewer.refresh.learn(order.plan, display_, rendered_, probes_.luma());
        figures.learnt_samples = display_.size() * framelet_samples;
    }
    if (!order.skips) {
        std::ranges::fill(needed_, std::uint8_t{1});
    }
    choose_qps(ImagePlane(order.state.view.viewport), order.plan.tiles, needed_, order.qp, order.still, viewer.lossy,
               batch_.qp);
    fill_batch(viewer);
    if (batch_.framelets.empty()) {
        return false;
    }
    if (order.takes_shapes) {
        describe_shapes(scene, viewer);
    }
    std::uint64_t const samples = batch_.framelets.size() * framelet_samples;
    figures.exact_samples = batch_.qp.empty() ? samples : 0;
    figures.lossy_samples = samples - figures.exact_samples;
    figures.shaped_samples = order.takes_shapes ? samples : 0;
    return true;
}

void BatchWork::describe_shapes(PosedScene const& scene, ViewerKnowledge& viewer) {
    Viewport const viewport = order.state.view.viewport;
    viewer.shapes.fit(rendered_, needed_, make_view_rays(order.state.view.camera, viewport), ImagePlane(viewport),
                      order.plan.moment_begun, batch_.shapes);
    viewer.shapes.track(scene.scene(), scene.clips(), scene.render_scene().bodies(), order.scene_camera,
                        order.present.scene_time, order.state.scene_time, batch_.tracks, batch_.camera_track);
    for (BodyTrack const& track : batch_.tracks) {
        viewer.motions.extend(track);
    }
    if (!order.again) { // by the tracks that the viewer has with it
        viewer.refresh.note_sent(order.plan, batch_.number, display_, rendered_, needed_, batch_.shapes);
    }
}

void BatchWork::fill_batch(ViewerKnowledge& viewer) {
    batch_.shapes.clear();
    batch_.tracks.clear();
    batch_.camera_track.reset();
    batch_.framelets.clear();
    for (std::size_t i = 0; i < display_.size(); ++i) {
        if (needed_[i] != 0) {
            batch_.framelets.push_back(display_[i]);
        }
    }
    batch_.view = order.state.view;
    batch_.scene_time = order.state.scene_time;
    batch_.shown_from = order.shown_from;
    batch_.outdates = order.outdates;
    batch_.number = batch_.framelets.empty() ? 0 : ++viewer.batches;
}

} // namespace framelet
