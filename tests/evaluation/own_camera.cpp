#include "tests/evaluation/own_camera.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include "client/core/camera/camera_path.h"
#include "common/error.h"
#include "tests/evaluation/measures/measures.h"
#include "tests/evaluation/reference.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

constexpr double walking_speed = 1.4; ///< metres a second
constexpr double begin = 1; ///< scene time, seconds; the walk has begun half a second before
constexpr double settling = 1; ///< seconds of the measured walk until the error is that of any later time
constexpr double walking = 2.5, standing = 1; ///< seconds of the run that the camera walks, then stands
constexpr double stay = 0.5; ///< seconds that the camera stays after a jump
constexpr double jump_rate = 30; ///< measurements a second after a jump
constexpr float most_turn = 40; ///< greatest turn at a jump, degrees to either side
constexpr double most_rise = 1.02;

double length_of(CameraPath const& path) {
    double length = 0;
    for (std::size_t i = 1; i < path.keys.size(); ++i) {
        length += static_cast<double>(glm::distance(path.keys[i - 1].position, path.keys[i].position));
    }
    return length;
}

/// Mean squared errors of `framelet` at each reference time, against `reference` of that index.
template <class ReferenceOf>
std::vector<double> errors_of(BenchScene& scene, RunParameters const& run, CostTable const& costs,
                              ReferenceOf&& reference) {
    std::vector<double> errors;
    double const machine = machine_factor(scene, run, costs);
    auto const method = make_method("framelet", method_setup(run, machine, costs));
    std::vector<Picture> shown;
    run_method(scene, *method, run, machine,
               [&](std::size_t, Picture const& picture, double) { shown.push_back(picture); });
    for (std::size_t i = 0; i < shown.size(); ++i) {
        errors.push_back(mean_squared_error(shown[i], reference(i)));
    }
    return errors;
}

json walk(BenchScene& scene, CameraPath const& path, OwnCameraOptions const& options) {
    double const rate = walking_speed * path.duration() / length_of(path);
    scene.flown = [&path, rate](SceneTime time) { return path.at(rate * time); };
    RunParameters run;
    run.viewport = options.viewport;
    run.frames_per_second = options.walk_machine;
    run.start = begin;
    run.scene_stops = walking;
    run.seconds = walking + standing;
    for (double time = settling; time < walking - 1e-6; time += 0.1) {
        run.reference_times.push_back(time);
    }
    run.reference_times.push_back(run.seconds);
    std::vector<double> errors = errors_of(scene, run, options.costs, [&](std::size_t i) {
        pose_at(scene, scene_time(run, run.reference_times[i]));
        return render_reference(scene, run.viewport, options.samples_per_side);
    });
    double const last = errors.back();
    errors.pop_back();
    double sum = 0;
    for (double const error : errors) {
        sum += error;
    }
    return {{"walking_psnr", psnr_from_mse(sum / static_cast<double>(errors.size()))},
            {"standing_psnr", psnr_from_mse(last)}};
}

json jump(BenchScene& scene, CameraPath const& path, OwnCameraOptions const& options) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> along(0, path.duration());
    std::uniform_real_distribution<float> turn(-glm::radians(most_turn), glm::radians(most_turn));
    std::vector<Camera> cameras;
    for (int i = 0; i <= options.jumps; ++i) { // one more, for before the first jump
        Camera camera = path.at(along(random));
        camera.orientation = glm::normalize(camera.orientation * glm::angleAxis(turn(random), Vec3(0, 1, 0)));
        cameras.push_back(camera);
    }
    RunParameters run;
    run.viewport = options.viewport;
    run.frames_per_second = options.jump_machine;
    run.start = begin;
    run.seconds = stay * options.jumps;
    run.reference_rate = jump_rate;
    // At the beginning of the run the first jump is due, and has just happened.
    scene.flown = [&](SceneTime time) {
        double const jumps = std::floor((time - begin) / stay + 1e-6) + 1;
        return cameras[static_cast<std::size_t>(std::clamp(jumps, 0.0, static_cast<double>(options.jumps)))];
    };
    std::size_t const each = static_cast<std::size_t>(std::lround(stay * jump_rate));
    Picture reference;
    std::vector<double> const errors = errors_of(scene, run, options.costs, [&](std::size_t i) {
        if (i % each == 0) {
            pose_at(scene, scene_time(run, reference_time(run, i)));
            reference = render_reference(scene, run.viewport, options.samples_per_side);
        }
        return reference;
    });
    int steady = 0;
    for (std::size_t i = 0; i < errors.size(); i += each) {
        auto const first = errors.begin() + static_cast<std::ptrdiff_t>(i);
        steady += never_rises({first, first + static_cast<std::ptrdiff_t>(std::min(each, errors.size() - i))}) ? 1 : 0;
    }
    return {{"jumps", options.jumps}, {"steady_jumps", steady}};
}

} // namespace

bool never_rises(std::vector<double> const& errors) {
    double least = INFINITY;
    for (double const error : errors) {
        if (error > most_rise * least) {
            return false;
        }
        least = std::min(least, error);
    }
    return true;
}

json measure_own_camera(std::filesystem::path const& file, std::filesystem::path const& camera,
                        OwnCameraOptions const& options) {
    CameraPath const path = read_camera_path(camera);
    if (!(length_of(path) > 0)) {
        throw InputError(camera.string() + ": there is nothing to walk along in it");
    }
    auto const scene = load_bench_scene(file, Clips::none);
    scene->flown = [&path](SceneTime) { return path.at(0); };
    pose_at(*scene, 0);
    scene->exposure = auto_exposure(*scene->render_scene, scene->camera);
    json figures{{"scene", scene->name}};
    figures.update(walk(*scene, path, options));
    figures.update(jump(*scene, path, options));
    return figures;
}

} // namespace framelet::bench
