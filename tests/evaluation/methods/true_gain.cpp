#include "tests/evaluation/methods/true_gain.h"

#include <algorithm>
#include <bit>

#include <tbb/parallel_for.h>

#include "server/render/display_framelet.h"
#include "tests/evaluation/methods/warp_viewer.h"
#include "tests/evaluation/reference.h"
#include "tests/uniform_tiling.h"

namespace framelet::bench {
namespace {

constexpr int finest = 2; ///< finest depth, counted from that of one sample a pixel
constexpr int reference_side = 3; ///< samples along a pixel's side, as the evaluation's reference has by default

std::vector<float> errors_by_pixel(Picture const& shown, Picture const& reference) {
    std::vector<float> errors(reference.rgba.size() / 4);
    for (std::size_t i = 0; i < errors.size(); ++i) {
        for (std::size_t c = 4 * i; c < 4 * i + 3; ++c) {
            float const off = static_cast<float>(shown.rgba[c] - reference.rgba[c]);
            errors[i] += off * off;
        }
    }
    return errors;
}

bool overlap(Tile a, Tile b) {
    int const deeper = 2 * (b.depth() - a.depth());
    return deeper >= 0 ? b.code >> deeper == a.code : a.code >> -deeper == b.code;
}

} // namespace

TrueGain::TrueGain(Viewport viewport, CostTable const& costs, int coarsest) : plane_(viewport), costs_(costs) {
    for (int deeper = -std::countr_zero(static_cast<unsigned>(coarsest)); deeper <= finest; ++deeper) {
        Level& level = levels_.emplace_back();
        level.depth = plane_.pixel_depth() + deeper;
        if (level.depth < plane_.min_depth()) {
            levels_.pop_back();
            continue;
        }
        level.tiles = make_uniform_tiling(plane_, level.depth).tiles;
        level.rendered.resize(level.tiles.size());
        level.displayed.resize(level.tiles.size());
        level.segments.resize(level.tiles.size());
        level.gains.resize(level.tiles.size());
    }
}

void TrueGain::look(BenchScene& scene, SceneTime rendered, SceneTime seen, double now, Picture const& held) {
    pose_at(scene, seen);
    Camera const seen_camera = scene.camera;
    ScenePose const seen_pose = scene.pose;
    pose_at(scene, rendered);
    bool const rests = scene.camera == seen_camera && same_pose(scene.pose, seen_pose);
    bool const same = still_looks_ >= 0 && rests && scene.camera == camera_ && same_pose(scene.pose, pose_);
    still_looks_ = same ? still_looks_ + 1 : 0;
    camera_ = scene.camera;
    pose_ = scene.pose;
    auto const is_new = [&](Level const& level) { return still_looks_ == (&level == &levels_.back() ? 1 : 0); };
    for (Level& level : levels_) {
        if (is_new(level)) {
            render(scene, level);
        }
    }
    pose_at(scene, seen);
    if (!same) {
        reference_ = render_reference(scene, plane_.viewport(), reference_side);
    }
    for (Level& level : levels_) {
        if (is_new(level)) {
            compare(scene, rendered, seen, now, level);
        }
    }
    pose_at(scene, rendered);
    held_errors_ = errors_by_pixel(held, reference_);
    depths_.assign(held_errors_.size(), -1);
}

void TrueGain::render(BenchScene const& scene, Level& level) const {
    ViewRays const rays = make_view_rays(scene.camera, plane_.viewport());
    tbb::parallel_for(std::size_t{0}, level.tiles.size(), [&](std::size_t i) {
        level.segments[i] = render_framelet(*scene.render_scene, rays, plane_, level.tiles[i], level.rendered[i]);
        level.displayed[i] = to_display(level.rendered[i], scene.exposure);
    });
}

void TrueGain::compare(BenchScene const& scene, SceneTime rendered, SceneTime seen, double now, Level& level) const {
    Batch batch;
    batch.number = 1;
    batch.view = {1, camera_, plane_.viewport()};
    batch.scene_time = rendered;
    batch.framelets = level.displayed;
    std::vector<std::uint8_t> const all(batch.framelets.size(), 1);
    level.shapes.fit(level.rendered, all, make_view_rays(camera_, plane_.viewport()), plane_, now, batch.shapes);
    // The viewer is a new one each time, which knows nothing yet and is told of all bodies.
    ShapeFeed().track(scene.scene, scene.clips, scene.render_scene->bodies(), -1, rendered, rendered, batch.tracks,
                      batch.camera_track);
    WarpViewer viewer(plane_.viewport(), costs_);
    viewer.insert(batch);
    viewer.present(scene.camera, seen);
    level.errors = errors_by_pixel(viewer.picture(), reference_);
}

/// Calls `look` with the index of each pixel of the tile that is in the picture.
template <class Look>
void TrueGain::each_pixel(Tile tile, Look&& look) const {
    PixelRect const rect = plane_.tile_rect(tile);
    auto const [width, height] = plane_.viewport();
    for (int y = rect.top; y < std::min(rect.bottom, height); ++y) {
        for (int x = rect.left; x < std::min(rect.right, width); ++x) {
            look(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
        }
    }
}

/// Error that the tile would take away; pixels that finer tiles of the same batch cover stay as they are.
double TrueGain::gain_of(Level const& level, Tile tile) const {
    double sum = 0;
    each_pixel(tile, [&](std::size_t i) { sum += level.depth > depths_[i] ? held_errors_[i] - level.errors[i] : 0; });
    return sum;
}

void TrueGain::take(Level const& level, Tile tile) {
    each_pixel(tile, [&](std::size_t i) {
        if (level.depth > depths_[i]) {
            held_errors_[i] = level.errors[i];
            depths_[i] = static_cast<std::int8_t>(level.depth);
        }
    });
}

std::vector<TrueGain::Chosen> TrueGain::choose(std::size_t most) {
    // The finest tiles are known only once nothing moves.
    std::size_t const known = still_looks_ > 0 ? levels_.size() : levels_.size() - 1;
    for (std::size_t l = 0; l < known; ++l) {
        Level& level = levels_[l];
        tbb::parallel_for(std::size_t{0}, level.tiles.size(),
                          [&](std::size_t i) { level.gains[i] = gain_of(level, level.tiles[i]); });
    }
    std::vector<Chosen> chosen;
    while (chosen.size() < most) {
        Level* best_level = nullptr;
        std::size_t best = 0;
        double most_gain = 0;
        for (std::size_t l = 0; l < known; ++l) {
            auto const found = std::ranges::max_element(levels_[l].gains);
            if (*found > most_gain) {
                most_gain = *found;
                best_level = &levels_[l];
                best = static_cast<std::size_t>(found - levels_[l].gains.begin());
            }
        }
        if (best_level == nullptr) {
            break;
        }
        Tile const tile = best_level->tiles[best];
        chosen.push_back({&best_level->rendered[best], &best_level->displayed[best], best_level->segments[best]});
        take(*best_level, tile);
        for (std::size_t l = 0; l < known; ++l) {
            Level& level = levels_[l];
            for (std::size_t i = 0; i < level.tiles.size(); ++i) {
                if (overlap(level.tiles[i], tile)) {
                    level.gains[i] = gain_of(level, level.tiles[i]);
                }
            }
        }
    }
    return chosen;
}

} // namespace framelet::bench
