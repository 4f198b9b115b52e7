#include "tests/evaluation/reference_picture.h"

#include <chrono>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "client/core/camera/camera_path.h"
#include "common/error.h"
#include "common/files/picture_writer.h"
#include "server/render/path/path_light.h"
#include "server/render/path/path_picture.h"

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
        if (is_exr) {
            write_exr(options.output, radiance);
        } else {
            write_png(options.output, to_display(radiance, exposure));
        }
    }
    figures["seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    std::printf("%s\n", figures.dump().c_str());
    return figures;
}

} // namespace framelet::bench
