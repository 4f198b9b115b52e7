#include "tests/evaluation/reference_picture.h"

#include <chrono>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "client/core/camera/camera_path.h"
#include "common/error.h"
#include "common/files/picture_writer.h"
#include "server/render/first_look.h"
#include "server/render/path/path_light.h"
#include "server/render/path/path_picture.h"
#include "server/render/picture_renderer.h"
#include "tests/evaluation/light_errors.h"
#include "tests/settled_light.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

Camera camera_of(BenchScene& scene, std::filesystem::path const& file) {
    if (file.empty()) {
        return scene.camera;
    }
    CameraPath const path = read_camera_path(file);
    if (path.scene_camera >= 0) {
        if (path.scene_camera >= static_cast<int>(scene.scene.cameras.size())) {
            throw InputError(file.string() + ": the scene has no such camera");
        }
        return scene.posed->camera(path.scene_camera, scene.pose.time);
    }
    return path.at(0, scene.scene.origin);
}

double seconds_since(std::chrono::steady_clock::time_point begun) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

void write_radiance(std::filesystem::path const& file, FloatImage const& radiance, float exposure) {
    if (file.extension() == ".exr") {
        write_exr(file, radiance);
    } else {
        write_png(file, to_display(radiance, exposure));
    }
}

/// Lets the scene move for a while, at the end of which it stands as it does now, and gathers light meanwhile. Returns
/// how many paths were gathered.
std::size_t gather_moving(BenchScene& scene, Camera const& camera, Viewport viewport, SceneTime end,
                          ReferencePictureOptions const& options, test::CachedLight& light) {
    constexpr double poses_per_second = 30;
    int const poses = std::max(1, static_cast<int>(std::lround(options.moved_seconds * poses_per_second)));
    std::size_t paths = 0;
    for (int i = 1; i <= poses; ++i) {
        pose_at(scene, end - (poses - i) / poses_per_second);
        light.update();
        render_radiance(*scene.render_scene, camera, viewport, 1);
        auto const due = static_cast<std::size_t>(options.gathered_per_second * i / poses_per_second);
        for (std::size_t done = 1; paths < due && done > 0; paths += done) {
            done = light.gathering().work(std::min<std::size_t>(due - paths, 4096));
        }
    }
    return paths;
}

/// Renders with the light cache, and adds how far that and direct light are off `paths`.
FloatImage render_full(BenchScene& scene, Camera const& camera, ReferencePictureOptions const& options,
                       PathOptions const& path_options, FloatImage const& paths, SceneTime time, float exposure,
                       json& figures) {
    constexpr int samples_per_side = 4;
    constexpr std::size_t most_paths = std::size_t{1} << 26;
    Viewport const viewport{paths.width, paths.height};
    auto const timed = [&](FloatImage& out) {
        auto const begun = std::chrono::steady_clock::now();
        out = render_radiance(*scene.render_scene, camera, viewport, samples_per_side);
        return seconds_since(begun);
    };
    FloatImage direct, full;
    double const direct_seconds = timed(direct);
    figures["direct"] = light_errors(direct, paths, exposure);
    float const size = glm::length(scene_bounds(scene.scene, scene.pose).size());
    bool const moves = options.moved_seconds > 0;
    if (moves) {
        pose_at(scene, time - options.moved_seconds);
    }
    test::CachedLight light(*scene.render_scene, path_options, size);
    std::size_t const settled = light.settle(camera, viewport, moves ? most_paths >> 5 : most_paths);
    auto const begun = std::chrono::steady_clock::now();
    figures["gathered_paths"] = moves ? gather_moving(scene, camera, viewport, time, options, light) : settled;
    figures["gathering_seconds"] = seconds_since(begun);
    figures["records"] = light.cache().records().size();
    double const full_seconds = timed(full);
    figures["full"] = light_errors(full, paths, exposure);
    figures["samples_per_second_over_direct"] = direct_seconds / full_seconds;
    return full;
}

} // namespace

json write_reference_picture(std::filesystem::path const& file, Viewport viewport, SceneTime time,
                             ReferencePictureOptions const& options) {
    bool const is_exr = options.output.extension() == ".exr";
    if (is_exr && options.direct) {
        throw InputError("--direct writes what viewers show: name a .png");
    }
    auto const scene = load_bench_scene(file, Clips::usual, options.environment);
    pose_at(*scene, time);
    Camera const camera = camera_of(*scene, options.camera);
    float const exposure = auto_exposure(*scene->render_scene, camera);
    auto const begun = std::chrono::steady_clock::now();
    json figures{{"scene", scene->name}, {"exposure", exposure}};
    if (options.direct) {
        write_png(options.output, render_picture(*scene->render_scene, camera, viewport, exposure, 4));
    } else {
        PathOptions paths = options.paths;
        paths.sizes = lamp_sizes({LightMethod::reference, options.sun_degrees, options.lamp_metres}, {});
        FloatImage const radiance = render_paths(*scene->render_scene, camera, viewport, paths);
        glm::dvec3 sum(0);
        for (Vec3 const& pixel : radiance.rgb) {
            sum += glm::dvec3(pixel) / static_cast<double>(radiance.rgb.size());
        }
        figures["mean_radiance"] = {sum.r, sum.g, sum.b};
        figures["paths"] = paths.paths;
        write_radiance(options.output,
                       options.full ? render_full(*scene, camera, options, paths, radiance, time, exposure, figures)
                                    : radiance,
                       exposure);
    }
    figures["seconds"] = seconds_since(begun);
    std::printf("%s\n", figures.dump().c_str());
    return figures;
}

} // namespace framelet::bench
