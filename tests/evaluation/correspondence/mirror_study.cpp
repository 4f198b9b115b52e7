#include "tests/evaluation/correspondence/mirror_study.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "common/color.h"
#include "common/picture/framelet_pool.h"
#include "common/reprojector.h"
#include "protocol/batch_codec.h"
#include "server/layers/layer_fit.h"
#include "server/schedule/tiling.h"
#include "tests/evaluation/bench_scene.h"
#include "tests/evaluation/correspondence/flight.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

struct Shot {
    SceneTime time = 0;
    Camera camera;
    float median_depth = 1; ///< metres
    std::vector<Framelet> framelets; ///< of a sample a pixel
};

Shot take_shot(BenchScene const& scene, Camera const& camera, Viewport viewport) {
    ImagePlane const plane(viewport);
    Tiling const tiling = make_uniform_tiling(plane, plane.pixel_depth());
    Shot out{scene.pose.time, camera, 1, {}};
    out.framelets.resize(tiling.tiles.size());
    render_framelets(*scene.render_scene, camera, plane, tiling.tiles, 0, out.framelets);
    out.median_depth = median_depth(out.framelets);
    return out;
}

struct Held {
    FrameletPool pool;
    BodyMotions motions;
};

/// As it arrives. `speed`: of the camera, metres a second; `ahead`: for how long bodies' motions are told, seconds.
void hold(Shot const& shot, BenchScene const& scene, Viewport viewport, float speed, double ahead, Held& held) {
    ImagePlane const plane(viewport);
    LayerTolerance const tolerance = layer_tolerance(shot.median_depth, make_view_rays(shot.camera, viewport), speed);
    Batch batch;
    batch.number = 1;
    batch.view = {1, shot.camera, viewport};
    batch.scene_time = shot.time;
    auto const first_key = static_cast<std::int64_t>(std::floor(shot.time * body_keys_per_second));
    auto const keys = static_cast<std::size_t>(std::ceil(ahead * body_keys_per_second)) + 2;
    batch.tracks = body_tracks(scene.scene, scene.clips, scene.render_scene->bodies(), first_key, keys);
    batch.shapes.resize(shot.framelets.size());
    for (std::size_t k = 0; k < shot.framelets.size(); ++k) {
        batch.framelets.push_back(to_display(shot.framelets[k], scene.exposure));
        fit_layers(shot.framelets[k], plane, tolerance, batch.shapes[k]);
    }
    BatchCodec codec;
    Batch const arrived = codec.decode(codec.encode(batch));
    held.pool.insert(arrived);
    for (BodyTrack const& track : arrived.tracks) {
        held.motions.extend(track);
    }
}

struct Errors {
    double pixels = 0;
    double moved = 0, left = 0; ///< sums of mean squared differences

    json to_json() const {
        return {{"pixels", pixels}, {"moved", moved / std::max(pixels, 1.0)}, {"left", left / std::max(pixels, 1.0)}};
    }
};

struct Found {
    Errors mirrors, others;
};

double squared_difference(std::uint8_t const* pixel, DisplayFramelet const& truth, std::uint32_t i) {
    double const red = pixel[0] - truth.red[i], green = pixel[1] - truth.green[i], blue = pixel[2] - truth.blue[i];
    return (red * red + green * green + blue * blue) / (3 * 255.0 * 255.0);
}

void compare(Shot const& after, float exposure, Picture const& moved, Picture const& left, Found& found) {
    ImagePlane const plane({moved.width, moved.height});
    for (Framelet const& framelet : after.framelets) {
        DisplayFramelet const truth = to_display(framelet, exposure);
        PixelRect const rect = plane.tile_rect(framelet.tile);
        for (std::uint32_t i = 0; i < framelet_samples; ++i) {
            int const x = rect.left + static_cast<int>(morton_x(i));
            int const y = rect.top + static_cast<int>(morton_y(i));
            if (x < moved.width && y < moved.height) {
                Errors& errors = framelet.reflects[i] ? found.mirrors : found.others;
                ++errors.pixels;
                errors.moved += squared_difference(moved.row(y) + 4 * x, truth, i);
                errors.left += squared_difference(left.row(y) + 4 * x, truth, i);
            }
        }
    }
}

/// Where the camera is so many seconds after `time`, at which it was `camera`.
Camera camera_after(BenchScene const& scene, Camera const& camera, float median_depth, SceneTime time, double seconds) {
    Camera const later = camera_at(scene, time + seconds);
    return later == camera ? flown(later, median_depth, seconds) : later;
}

void measure_from(BenchScene& scene, MirrorStudy const& study, SceneTime time, std::vector<Found>& found) {
    pose_at(scene, time);
    Shot const before = take_shot(scene, scene.camera, study.viewport);
    constexpr double instant = 1.0 / 60;
    float const speed = glm::distance(camera_after(scene, before.camera, before.median_depth, time, instant).position,
                                      before.camera.position) /
                        static_cast<float>(instant);
    Held held{FrameletPool(ImagePlane(study.viewport)), {}};
    hold(before, scene, study.viewport, speed, *std::ranges::max_element(study.ahead), held);
    Reprojector reprojector;
    std::vector<PixelRect> changed, repainted;
    held.pool.newest().take_changed(changed);
    Picture left(study.viewport.width, study.viewport.height);
    reprojector.show(held.pool, changed, before.camera, time, held.motions, left, repainted);
    Picture moved = left;
    for (std::size_t i = 0; i < study.ahead.size(); ++i) {
        SceneTime const later = time + study.ahead[i];
        Camera const camera = camera_after(scene, before.camera, before.median_depth, time, study.ahead[i]);
        pose_at(scene, later);
        Shot const after = take_shot(scene, camera, study.viewport);
        reprojector.show(held.pool, {}, camera, later, held.motions, moved, repainted);
        compare(after, scene.exposure, moved, left, found[i]);
    }
}

} // namespace

json measure_mirrors(MirrorStudy const& study) {
    std::printf("%dx%d, a sample per pixel; mean squared error where a reflection was traced, and elsewhere\n",
                study.viewport.width, study.viewport.height);
    std::printf("%-18s ahead [ms] |  mirrors     moved      left | others     moved      left\n", "");
    json rows = json::array();
    for (std::filesystem::path const& file : study.scenes) {
        auto const scene = load_bench_scene(file, study.camera);
        std::vector<Found> found(study.ahead.size());
        int const times = scene->duration > 0 ? study.times : 1;
        for (int k = 0; k < times; ++k) {
            measure_from(*scene, study, scene->duration * (k + 0.5) / times, found);
        }
        for (std::size_t i = 0; i < found.size(); ++i) {
            Errors const& mirrors = found[i].mirrors;
            Errors const& others = found[i].others;
            double const all = mirrors.pixels + others.pixels;
            auto const mean = [](double sum, Errors const& errors) { return sum / std::max(errors.pixels, 1.0); };
            std::printf("%-18s %10.1f | %7.2f%% %9.2e %9.2e | %5.1f%% %9.2e %9.2e\n", scene->name.c_str(),
                        1e3 * study.ahead[i], 100 * mirrors.pixels / all, mean(mirrors.moved, mirrors),
                        mean(mirrors.left, mirrors), 100 * others.pixels / all, mean(others.moved, others),
                        mean(others.left, others));
            std::fflush(stdout);
            rows.push_back({{"scene", scene->name},
                            {"ahead_seconds", study.ahead[i]},
                            {"mirrors", mirrors.to_json()},
                            {"others", others.to_json()}});
        }
    }
    return rows;
}

} // namespace framelet::bench
