#include "tests/evaluation/correspondence/correspondence.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "common/held/framelet_cache.h"
#include "common/warp/warp_block.h"
#include "protocol/codec/batch_codec.h"
#include "server/stream/layers/layer_fit.h"
#include "tests/evaluation/bench_scene.h"
#include "tests/evaluation/correspondence/exact_motion.h"
#include "tests/evaluation/correspondence/position_code.h"
#include "tests/evaluation/figure_table.h"
#include "tests/uniform_tiling.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

/// Times ahead to which pictures are moved, seconds.
constexpr double times_ahead[] = {1.0 / 60, 1.0 / 15, 0.2};

/// Share by which inverse depths must differ more than their neighbours do to be of two surfaces.
constexpr float same_surface = 0.01f;

/// Surfaces that the pixels of a picture show.
struct Surfaces {
    Viewport viewport;
    std::vector<Framelet> framelets;
    std::vector<float> inverse_depth;
    std::vector<BodyNumber> body;
    std::vector<Drift> drift;

    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(viewport.width) + static_cast<std::size_t>(x);
    }
};

Surfaces render_surfaces(BenchScene& scene, Camera const& camera, Viewport viewport) {
    ImagePlane const plane(viewport);
    Tiling const tiling = make_uniform_tiling(plane, plane.pixel_depth());
    Surfaces out{viewport, {}, {}, {}, {}};
    out.framelets.resize(tiling.tiles.size());
    render_framelets(*scene.render_scene, camera, plane, tiling.tiles, out.framelets);
    auto const pixels = static_cast<std::size_t>(viewport.width) * static_cast<std::size_t>(viewport.height);
    out.inverse_depth.resize(pixels);
    out.body.resize(pixels);
    out.drift.resize(pixels);
    for (Framelet const& framelet : out.framelets) {
        PixelRect const rect = plane.tile_rect(framelet.tile);
        for (std::uint32_t i = 0; i < framelet_samples; ++i) {
            int const x = rect.left + static_cast<int>(morton_x(i));
            int const y = rect.top + static_cast<int>(morton_y(i));
            if (x < viewport.width && y < viewport.height) {
                out.inverse_depth[out.index(x, y)] = 1 / framelet.depth[i];
                out.body[out.index(x, y)] = framelet.body.empty() ? static_body : framelet.body[i];
                out.drift[out.index(x, y)] = framelet.drift.empty() ? Drift{} : framelet.drift[i];
            }
        }
    }
    return out;
}

/// True where the picture shows that surface there: its inverse depth is among those of the pixels around.
bool shows(Surfaces const& surfaces, ExactMotion::Projected const& there, BodyNumber body) {
    auto const [width, height] = surfaces.viewport;
    Vec2 const pixel = there.pixel;
    if (!(pixel.x >= 0.5f && pixel.y >= 0.5f && pixel.x <= static_cast<float>(width) - 0.5f &&
          pixel.y <= static_cast<float>(height) - 0.5f)) {
        return false;
    }
    float least = INFINITY, most = -INFINITY;
    int const x = static_cast<int>(pixel.x);
    int const y = static_cast<int>(pixel.y);
    if (surfaces.body[surfaces.index(std::min(x, width - 1), std::min(y, height - 1))] != body) {
        return false;
    }
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, height - 1); ++j) {
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, width - 1); ++i) {
            if (surfaces.body[surfaces.index(i, j)] == body) {
                least = std::min(least, surfaces.inverse_depth[surfaces.index(i, j)]);
                most = std::max(most, surfaces.inverse_depth[surfaces.index(i, j)]);
            }
        }
    }
    float const margin = same_surface * there.inverse_depth;
    return there.inverse_depth >= least - margin && there.inverse_depth <= most + margin;
}

/// Fills a viewer's cache with a picture whose colours are the pixels' positions, coded and decoded. `speed`: that of
/// the camera, metres a second.
void hold_positions(Surfaces const& surfaces, BenchScene const& scene, Camera const& camera, float speed, int shift,
                    FrameletCache& cache, std::vector<BodyTrack> const& tracks, BodyMotions& motions) {
    ImagePlane const plane(surfaces.viewport);
    LayerTolerance const tolerance =
        layer_tolerance(median_depth(surfaces.framelets), make_view_rays(camera, surfaces.viewport), speed);
    Batch batch;
    batch.number = 1;
    batch.view = {1, camera, surfaces.viewport};
    batch.scene_time = scene.pose.time;
    batch.tracks = tracks;
    batch.shapes.resize(surfaces.framelets.size());
    for (std::size_t k = 0; k < surfaces.framelets.size(); ++k) {
        DisplayFramelet& out = batch.framelets.emplace_back();
        out.tile = surfaces.framelets[k].tile;
        PixelRect const rect = plane.tile_rect(out.tile);
        out.blue.fill(0);
        for (std::uint32_t i = 0; i < framelet_samples; ++i) {
            out.red[i] = position_byte(rect.left + static_cast<int>(morton_x(i)), shift);
            out.green[i] = position_byte(rect.top + static_cast<int>(morton_y(i)), shift);
        }
        fit_layers(surfaces.framelets[k], plane, tolerance, batch.shapes[k]);
    }
    BatchCodec codec;
    Batch const arrived = codec.decode(codec.encode(batch));
    cache.insert(arrived);
    for (BodyTrack const& track : arrived.tracks) {
        motions.extend(track);
    }
}

struct Found {
    double pixels = 0, all_holes = 0; ///< counted over all pixels, whether visible before or not
    double visible = 0, tenth = 0, half = 0, one = 0, holes = 0;

    void add(float error) {
        ++visible;
        holes += std::isinf(error) ? 1 : 0;
        tenth += error <= 0.1f ? 1 : 0;
        half += error <= 0.5f ? 1 : 0;
        one += error <= 1.0f ? 1 : 0;
    }
    double share(double count) const { return visible > 0 ? count / visible : 1; }
};

void compare(Surfaces const& before, Surfaces const& after, ExactMotion const& back, WarpPlan (&plans)[2],
             Found& found) {
    constexpr int side = WarpedBlock::side;
    Viewport const viewport = after.viewport;
    std::vector<PatchView> patches;
    for (std::size_t b = 0;
         b < static_cast<std::size_t>(plans[0].columns()) * static_cast<std::size_t>(plans[0].rows()); ++b) {
        int const column = static_cast<int>(b) % plans[0].columns();
        int const row = static_cast<int>(b) / plans[0].columns();
        WarpedBlock blocks[2];
        for (int shift = 0; shift < 2; ++shift) {
            patches.clear();
            plans[shift].add_block(b, patches);
            paint_warped_block(patches, column, row, viewport, blocks[shift]);
        }
        for (int i = 0; i < side * side; ++i) {
            int const x = column * side + i % side;
            int const y = row * side + i / side;
            if (x >= viewport.width || y >= viewport.height) {
                continue;
            }
            auto const k = static_cast<std::size_t>(i);
            std::size_t const at = after.index(x, y);
            Vec2 const pixel = Vec2(x, y) + 0.5f;
            bool const is_hole = blocks[0].inverse_depth[k] == hole_depth;
            ++found.pixels;
            found.all_holes += is_hole ? 1 : 0;
            ExactMotion::Projected const exact =
                back.shown(pixel, after.inverse_depth[at], after.body[at], after.drift[at]);
            if (!shows(before, exact, after.body[at])) {
                continue;
            }
            int const shift_x = steady_shift(exact.pixel.x);
            int const shift_y = steady_shift(exact.pixel.y);
            Vec2 const taken(position_of(blocks[shift_x].squares[0][k], shift_x, exact.pixel.x),
                             position_of(blocks[shift_y].squares[1][k], shift_y, exact.pixel.y));
            found.add(is_hole ? INFINITY : glm::distance(taken, exact.pixel));
        }
    }
}

/// Measures all times ahead from one time of the scene. `found`: one for each of `times_ahead`.
void measure_from(BenchScene& scene, Viewport viewport, SceneTime time, std::span<Found> found) {
    ImagePlane const plane(viewport);
    pose_at(scene, time);
    Camera const camera = scene.camera;
    ScenePose const pose = scene.pose;
    SceneBodies const& bodies = scene.render_scene->bodies();
    Surfaces const before = render_surfaces(scene, camera, viewport);
    auto const first_key = static_cast<std::int64_t>(std::floor(time * body_keys_per_second));
    double const farthest = *std::ranges::max_element(times_ahead);
    auto const keys = static_cast<std::size_t>(std::ceil(farthest * body_keys_per_second)) + 2;
    std::vector<BodyTrack> const tracks = body_tracks(scene.posed->poses(), bodies, first_key, keys);
    constexpr double instant = 1.0 / 60;
    float const speed =
        glm::distance(camera_at(scene, time + instant).position, camera.position) / static_cast<float>(instant);
    FrameletCache caches[2]{FrameletCache(plane), FrameletCache(plane)};
    BodyMotions motions;
    for (int shift = 0; shift < 2; ++shift) {
        hold_positions(before, scene, camera, speed, shift, caches[shift], tracks, motions);
    }
    for (std::size_t i = 0; i < found.size(); ++i) {
        SceneTime const later = time + times_ahead[i];
        pose_at(scene, later);
        Camera const moved = scene.camera;
        Surfaces const after = render_surfaces(scene, moved, viewport);
        WarpPlan plans[2];
        for (int shift = 0; shift < 2; ++shift) {
            plans[shift].make(caches[shift], 0, {}, moved, later, motions);
        }
        ExactMotion const back(bodies, {scene.pose, moved}, {pose, camera}, viewport);
        compare(before, after, back, plans, found[i]);
    }
}

} // namespace

json measure_correspondence(StudyOptions const& study, int times) {
    Viewport const viewport = study.run.viewport;
    std::printf("%dx%d, a sample per pixel; share of the pixels that were visible already, %%\n", viewport.width,
                viewport.height);
    FigureTable const table({{"scene", "/scene", -17},
                             {"ahead [ms]", "/ahead_seconds", 10, 1, 1e3},
                             {"visible", "/visible", 8, 2, 100},
                             {"<= 0.1", "/within_0.1", 8, 2, 100},
                             {"<= 0.5", "/within_0.5", 8, 2, 100},
                             {"<= 1", "/within_1", 8, 2, 100},
                             {"holes", "/holes", 8, 3, 100},
                             {"holes of all", "/holes_of_all_pixels", 12, 2, 100}});
    json rows = json::array();
    for (std::filesystem::path const& file : study.scenes) {
        auto const scene = load_bench_scene(file);
        std::vector<Found> found(std::size(times_ahead));
        int const moments = scene->duration > 0 ? times : 1;
        for (int k = 0; k < moments; ++k) {
            measure_from(*scene, viewport, scene->duration * (k + 0.5) / moments, found);
        }
        for (std::size_t i = 0; i < found.size(); ++i) {
            Found const& f = found[i];
            rows.push_back({{"scene", scene->name},
                            {"ahead_seconds", times_ahead[i]},
                            {"visible", f.visible / f.pixels},
                            {"within_0.1", f.share(f.tenth)},
                            {"within_0.5", f.share(f.half)},
                            {"within_1", f.share(f.one)},
                            {"holes", f.share(f.holes)},
                            {"holes_of_all_pixels", f.all_holes / f.pixels}});
            table.print(rows.back());
        }
    }
    return rows;
}

} // namespace framelet::bench
