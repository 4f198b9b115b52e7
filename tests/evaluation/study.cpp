#include "tests/evaluation/study.h"

#include <cmath>
#include <string>

#include "client/core/camera/camera_path.h"
#include "common/error.h"
#include "server/render/first_look.h"
#include "tests/evaluation/scene_events.h"

namespace framelet::bench {

Reference reference_of(BenchScene& scene, StudyOptions const& options) {
    RunParameters const& run = options.run;
    return {scene,
            {run.viewport, run.seconds, run.reference_rate, options.samples_per_side, run.start, run.clock_settings},
            options.reference_cache};
}

Subject prepare(std::filesystem::path const& file, StudyOptions const& options) {
    auto scene = load_bench_scene(file, options.events == Events::baked ? Clips::baked : Clips::usual);
    scene->turn.degrees_per_second = options.turn;
    scene->orthographic_height = options.orthographic_height;
    StudyOptions of_scene = options;
    if (options.sees_events) {
        of_scene.run.start = window_start(scene->name, options.run.seconds);
    }
    std::string kind; // for the name, by which references are kept
    if (options.events == Events::set) {
        of_scene.run.clock_settings = unannounced_settings(scene->name, scene->duration, options.run.seconds);
        kind += "-set";
    } else if (options.events == Events::baked) {
        kind += "-baked";
    }
    if (!options.camera.empty()) {
        CameraPath const path = read_camera_path(options.camera);
        if (path.keys.empty()) {
            throw InputError(options.camera.string() + ": there are no keys to fly along in it");
        }
        scene->flown = [path](SceneTime time) { return path.at(time); };
        kind += '-' + options.camera.stem().string();
    }
    if (options.orthographic_height > 0) {
        kind += "-orthographic" + std::to_string(std::lround(100 * options.orthographic_height)) + "cm";
    }
    if (!kind.empty()) {
        scene->name += kind;
        scene->camera = camera_at(*scene, 0);
        scene->exposure = auto_exposure(*scene->render_scene, scene->camera);
        scene->render_scene->set_display(scene->exposure);
    }
    Reference reference = reference_of(*scene, of_scene);
    double const machine = machine_factor(*scene, of_scene.run, options.costs);
    return {std::move(scene), of_scene.run, std::move(reference), machine};
}

} // namespace framelet::bench
