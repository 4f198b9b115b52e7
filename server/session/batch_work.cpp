#include "server/session/batch_work.h"

#include <algorithm>
#include <utility>

#include <tbb/parallel_for.h>

#include "server/render/display_renderer.h"
#include "server/session/laps.h"

namespace framelet {
void BatchWork::render(SharedScene const& shared) {
    std::size_t const count = order.plan.tiles.size();
    rendered_pool_.resize(std::max(rendered_pool_.size(), count));
    display_pool_.resize(std::max(display_pool_.size(), count));
    rendered_ = std::span(rendered_pool_).first(count);
    display_ = std::span(display_pool_).first(count);
    NumberedView const& view = order.state.view;
    ImagePlane const plane(view.viewport);
    ViewRays const rays = make_view_rays(view.camera, view.viewport);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        render_display(shared.render_scene, rays, plane, order.plan.tiles[i], order.state.exposure,
                       order.plan.rays_per_sample, fresh_.local(), rendered_[i], display_[i]);
    });
    probes_.render(shared.render_scene, view.camera, view.viewport, order.state.exposure, order.plan.probes);
}

void BatchWork::learn(SharedScene const& shared) {
    ViewerState& viewer = *order.viewer;
    Laps laps;
    if (order.again) {
        needed_.assign(display_.size(), 1);
    } else {
        needed_ = viewer.refresh.learn(order.plan, display_, rendered_, probes_.luma());
    }
    record.stage_seconds.learn = laps.lap();
    choose_qualities(ImagePlane(order.state.view.viewport), order.plan.tiles, needed_, order.quality, order.still,
                     viewer.lossy, batch_.quality);
    batch_.shapes.clear();
    batch_.tracks.clear();
    if (order.input.takes_shapes() && std::ranges::count(needed_, 0) < std::ssize(needed_)) { // else nothing is sent
        describe_shapes(shared);
    }
    record.stage_seconds.shape = laps.lap();
    begin_batch();
    complete_ = viewer.refresh.is_complete(order.state) && viewer.lossy.empty();
    record.framelets_sent = batch_.framelets.size();
    record.framelets_unchanged = needed_.size() - batch_.framelets.size();
}

bool BatchWork::send(BatchCodec& codec) {
    if (batch_.number > 0) {
        order.session->send_batch(codec.encode(batch_, order.session->held_picture()));
    }
    return order.session->report(order.input.version, complete_);
}

void BatchWork::describe_shapes(SharedScene const& shared) {
    Viewport const viewport = order.state.view.viewport;
    ShapeFeed& shapes = order.viewer->shapes;
    shapes.fit(rendered_, needed_, make_view_rays(order.state.view.camera, viewport), ImagePlane(viewport),
               order.plan.now, batch_.shapes);
    if (!order.again) {
        bind_to_picture(order.plan, needed_, order.viewer->refresh.staying(), batch_.shapes);
    }
    shapes.track(shared.scene, shared.clips, shared.render_scene.bodies(), order.state.scene_time, batch_.tracks);
    for (BodyTrack const& track : batch_.tracks) {
        order.viewer->motions.extend(track);
    }
}

void BatchWork::begin_batch() {
    batch_.number = 0;
    batch_.framelets.clear();
    for (std::size_t i = 0; i < display_.size(); ++i) {
        if (needed_[i] != 0) {
            batch_.framelets.push_back(display_[i]);
        }
    }
    if (batch_.framelets.empty() || !order.session->is_open()) {
        return;
    }
    batch_.number = order.session->begin_batch(static_cast<double>(batch_.framelets.size() * framelet_samples));
    batch_.view = order.state.view;
    batch_.scene_time = order.state.scene_time;
}

} // namespace framelet
