#include "server/stream/batch_work.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include <tbb/parallel_for.h>

#include "common/laps.h"
#include "common/marked_indices.h"
#include "server/render/display_framelet.h"
#include "server/render/display_renderer.h"
#include "server/render/visibility.h"
#include "server/sampling/plan/completion.h"

namespace framelet {
namespace {

/// Mean squared error (`squared_error`) from which on paths look better than the light cache: a hundredth of white.
constexpr float smooth_enough = 1e-4f;

/// Replaces `shapes` by those of the framelets for which `send` is not 0, with each sample by itself: on no layer.
void list_samples(std::span<Framelet const> rendered, std::span<std::uint8_t const> send,
                  std::vector<FrameletShape>& shapes) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < rendered.size(); ++i) {
        if (send[i] == 0) {
            continue;
        }
        shapes.resize(std::max(shapes.size(), ++count));
        FrameletShape& shape = shapes[count - 1];
        shape.layer_of.fill(FrameletShape::outlier);
        shape.outliers.resize(framelet_samples);
        for (std::size_t k = 0; k < framelet_samples; ++k) {
            shape.outliers[k] = {rendered[i].depth[k] > 0 ? 1 / rendered[i].depth[k] : 0,
                                 rendered[i].body.empty() ? static_body : rendered[i].body[k],
                                 rendered[i].drift.empty() ? Drift{} : rendered[i].drift[k]};
        }
    }
    shapes.resize(count);
}

} // namespace

void BatchWork::render(PosedScene const& scene, PathSums& sums, WorkerPool* workers) {
    std::size_t const count = order.plan.tiles.size();
    rendered_pool_.resize(std::max(rendered_pool_.size(), count));
    display_pool_.resize(std::max(display_pool_.size(), count));
    rendered_ = std::span(rendered_pool_).first(count);
    display_ = std::span(display_pool_).first(count);
    NumberedView const& view = order.state.view;
    ImagePlane const plane(view.viewport);
    ViewRays const rays = make_view_rays(view.camera, view.viewport);
    int const rays_per_sample = order.plan.rays_per_sample;
    bool const by_paths = scene.path_light() != nullptr;
    LightGathering* const gathering = scene.light_gathering();
    // Of surfaces there are no more than four rays, where the light cache shows their light, else one.
    int const surface_rays =
        by_paths ? (gathering != nullptr && rays_per_sample > single_ray ? four_rays : single_ray) : rays_per_sample;
    std::size_t const paths = by_paths ? begin_paths(scene, sums, workers) : 0;
    std::atomic<std::uint64_t> segments = paths;
    std::atomic<double> took = 0; // processor seconds
    fresh_.prepare();
    if (!by_paths || are_shown(rays_per_sample)) {
        std::span<DisplayFramelet> const shown = by_paths ? std::span(direct_).first(count) : display_;
        tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
            Laps laps;
            segments.fetch_add(render_display(scene.render_scene(), rays, plane, order.plan.tiles[i],
                                              order.state.transform, surface_rays, order.plan.will_be_moved,
                                              fresh_.local(), rendered_[i], shown[i]),
                               std::memory_order_relaxed);
            took.fetch_add(laps.lap(), std::memory_order_relaxed);
        });
    }
    if (by_paths) {
        round_.finish();
        tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) { show_paths(scene, i, first_path_[i], sums); });
    }
    if (gathering != nullptr) {
        // Samples at rest, of many paths each, say nothing of those in motion, by which paths are planned.
        gathering->finish(rays_per_sample == single_ray ? count * framelet_samples : 0, took);
    }
    if (order.plan.checks && order.plan.checks->visibility) {
        segments +=
            render_visibility(scene.render_scene(), rays, view.viewport, *order.plan.checks->visibility, visibility_);
    }
    figures.segments = segments;
    figures.probe_segments =
        probes_.render(scene.render_scene(), view.camera, view.viewport, order.state.transform, order.plan.probes);
}

/// Begins with the paths of all framelets, and with some for the light cache. Returns how many the former are.
std::size_t BatchWork::begin_paths(PosedScene const& scene, PathSums& sums, WorkerPool* workers) {
    std::size_t const count = order.plan.tiles.size();
    int const most = order.plan.rays_per_sample;
    LightGathering* const gathering = scene.light_gathering();
    direct_.resize(std::max(direct_.size(), count));
    errors_.assign(count, INFINITY);
    first_path_.resize(count);
    std::vector<TilePath> paths;
    if (most > single_ray) {
        sums.hold(ImagePlane(order.state.view.viewport));
    }
    for (std::size_t i = 0; i < count; ++i) {
        first_path_[i] = paths.size();
        Tile const tile = order.plan.tiles[i];
        if (most > single_ray) {
            for (int path = first_to_add(sums[tile], most); path < most; ++path) {
                paths.push_back({tile, static_cast<std::uint32_t>(path)});
            }
        } else if (gathering == nullptr) {
            paths.push_back({tile, 0});
        }
    }
    std::size_t const traced = paths.size() * framelet_samples;
    std::size_t const packets =
        gathering != nullptr ? gathering->plan(light_paths(*gathering, count), LightCache::Use::recent) : 0;
    round_.begin(workers, *scene.path_light(), {order.state.scene_time, order.state.view}, std::move(paths), gathering,
                 packets);
    return traced;
}

/// Paths for the light cache, as long as it wants some, beside so many framelets: at rest as many as these have.
std::size_t BatchWork::light_paths(LightGathering const& gathering, std::size_t framelets) const {
    std::size_t const samples = framelets * framelet_samples;
    int const rays = order.plan.rays_per_sample;
    return rays > single_ray ? samples * static_cast<std::size_t>(new_rays(rays)) : gathering.paths_beside(samples);
}

/// Adds a framelet's paths, the first of which is number `first_path` of the round, and decides by what it is shown.
void BatchWork::show_paths(PosedScene const& scene, std::size_t index, std::size_t first_path, PathSums& sums) {
    bool const has_cache = scene.light_gathering() != nullptr;
    int const paths = order.plan.rays_per_sample;
    DisplayTransform const& transform = order.state.transform;
    bool shows_paths = !has_cache;
    TileSums first;
    TileSums& tile_sums = paths > single_ray ? sums[order.plan.tiles[index]] : first;
    if (paths > single_ray || !has_cache) {
        for (std::size_t i = first_path; tile_sums.paths < paths; ++i) {
            add_path(round_.light()[i], tile_sums);
        }
    }
    if (paths > single_ray) {
        errors_[index] = squared_error(tile_sums, transform);
        shows_paths = !has_cache || errors_[index] <= smooth_enough || paths >= completion_of_paths.most_rays;
    }
    if (!are_shown(paths)) {
        return;
    }
    rendered_[index].is_supersampled = paths > single_ray;
    if (!shows_paths) {
        display_[index] = direct_[index];
        return;
    }
    Framelet& fresh = fresh_.local();
    fresh.tile = order.plan.tiles[index];
    set_means(tile_sums, fresh);
    display_[index] = to_display(fresh, transform);
}

bool BatchWork::learn(PosedScene& scene, ViewerKnowledge& viewer) {
    if (order.plan.checks && order.plan.checks->visibility) {
        viewer.refresh.note_visibility(order.plan, visibility_);
    }
    if (order.again) {
        needed_.assign(display_.size(), 1);
    } else {
        needed_ = viewer.refresh.learn(order.plan, display_, rendered_, probes_.looks(), errors_);
        figures.learnt_samples = display_.size() * framelet_samples;
    }
    if (!are_shown(order.plan.rays_per_sample)) {
        return false;
    }
    if (!order.skips) {
        std::ranges::fill(needed_, std::uint8_t{1});
    }
    HeldTiles& held = viewer.refresh.held_tiles();
    if (order.state.view.viewport != held.plane().viewport()) { // the picture has another size by now
        std::ranges::fill(needed_, std::uint8_t{0});
    }
    choose_qps(order.plan.tiles, needed_, order.qp, order.last_depth, held, batch_.qp);
    fill_batch(viewer);
    if (batch_.framelets.empty()) {
        return false;
    }
    describe_shapes(scene, viewer);
    std::uint64_t const samples = batch_.framelets.size() * framelet_samples;
    figures.exact_samples = batch_.qp.empty() ? samples : 0;
    figures.lossy_samples = samples - figures.exact_samples;
    figures.shaped_samples = order.takes_shapes ? samples : 0;
    return true;
}

/// Makes what a viewer that moves its samples is told of them. Of one that does not the server has to know it too.
void BatchWork::describe_shapes(PosedScene& scene, ViewerKnowledge& viewer) {
    Viewport const viewport = order.state.view.viewport;
    if (order.takes_shapes) {
        viewer.shapes.fit(rendered_, needed_, make_view_rays(order.state.view.camera, viewport), ImagePlane(viewport),
                          order.plan.moment_begun, batch_.shapes);
    }
    viewer.shapes.track(scene.poses(), scene.render_scene().bodies(), order.scene_camera, order.present.scene_time,
                        order.state.scene_time, batch_.tracks, batch_.camera_track);
    for (BodyTrack const& track : batch_.tracks) {
        viewer.motions.extend(track);
    }
    if (!order.again) { // by the tracks that the viewer has with it
        bool const moves_samples = order.plan.moment.moves_samples;
        if (!moves_samples) {
            list_samples(rendered_, needed_, loose_shapes_);
        }
        std::span<DisplayFramelet const> const seen =
            errors_.empty() ? display_ : std::span(direct_).first(display_.size());
        viewer.refresh.note_sent(order.plan, batch_.number, seen, rendered_, needed_,
                                 moves_samples ? batch_.shapes : loose_shapes_);
    }
    if (!order.takes_shapes) {
        batch_.tracks.clear();
        batch_.camera_track.reset();
    }
}

void BatchWork::fill_batch(ViewerKnowledge& viewer) {
    batch_.shapes.clear();
    batch_.tracks.clear();
    batch_.camera_track.reset();
    list_marked(needed_, sent_);
    batch_.framelets.resize(sent_.size());
    tbb::parallel_for(std::size_t{0}, sent_.size(), [&](std::size_t i) { batch_.framelets[i] = display_[sent_[i]]; });
    batch_.view = order.state.view;
    batch_.scene_time = order.state.scene_time;
    batch_.shown_from = order.shown_from;
    batch_.outdates = order.outdates;
    batch_.number = batch_.framelets.empty() ? 0 : ++viewer.batches;
}

} // namespace framelet
