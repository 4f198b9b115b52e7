#include "tests/evaluation/pauses.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include "common/files/picture_writer.h"
#include "tests/evaluation/figure_table.h"
#include "tests/evaluation/measures/measures.h"
#include "tests/evaluation/paused_viewer.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

constexpr double most_seconds = 60; ///< until a picture is complete

/// A number in [0, 1).
double share(std::mt19937& random) {
    return static_cast<double>(random() % 4096) / 4096;
}

/// One of the scene's cameras that move, or of those that stand if none does; -1: it has none.
int any_camera(BenchScene const& scene, std::mt19937& random) {
    std::vector<int> moving, all;
    for (int i = 0; i < static_cast<int>(scene.scene.cameras.size()); ++i) {
        all.push_back(i);
        if (scene.posed->camera_moves(i)) {
            moving.push_back(i);
        }
    }
    std::vector<int> const& cameras = moving.empty() ? all : moving;
    return cameras.empty() ? -1 : cameras[random() % cameras.size()];
}

Camera turned_by(Camera camera, float radians) {
    camera.orientation = glm::normalize(glm::angleAxis(radians, Vec3(0, 1, 0)) * camera.orientation);
    return camera;
}

int differing_pixels(Picture const& a, Picture const& b) {
    if (a.width != b.width || a.height != b.height) {
        return std::max(a.width * a.height, b.width * b.height);
    }
    int count = 0;
    for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
        count += std::memcmp(&a.rgba[i], &b.rgba[i], 4) != 0 ? 1 : 0;
    }
    return count;
}

/// Flies the viewer's own camera for so many seconds, and lets it stand.
void fly(PausedViewer& viewer, double seconds) {
    constexpr double step = 1.0 / 60;
    constexpr float turn = 0.6f; // radians a second
    for (double flown = 0; flown < seconds; flown += step) {
        viewer.look(turned_by(viewer.camera(), turn * static_cast<float>(step)), -1);
        viewer.run(step);
    }
}

/// Runs until the picture is complete, if it ever is; returns what was shown after `soon_seconds`.
Picture complete(PausedViewer& viewer, bool& is_complete) {
    viewer.run(soon_seconds);
    Picture soon = viewer.picture();
    is_complete = viewer.run_until_complete(most_seconds);
    return soon;
}

} // namespace

std::string name_of(Stop stop) {
    switch (stop) {
    case Stop::scene_camera:
        return "scene_camera";
    case Stop::own_camera:
        return "own_camera";
    case Stop::seek:
        return "seek";
    case Stop::clip_end:
        return "clip_end";
    case Stop::resize:
        return "resize";
    }
    return {};
}

PauseOutcome pause_once(BenchScene& scene, Stop stop, PauseOptions const& options) {
    std::mt19937 random(static_cast<std::uint32_t>(options.seed));
    int const scene_camera = stop == Stop::own_camera ? -1 : any_camera(scene, random);
    double const length = std::max(scene.duration, 1.0);
    double const played = 0.3 + 0.7 * share(random);
    SceneTime const begun = stop == Stop::clip_end ? std::max(length - played, 0.0) : length * share(random);
    Viewport viewport = options.viewport;
    PausedViewer viewer(scene, viewport, options.rate, begun);
    Camera const looked = own_camera_at(scene, begun);
    viewer.look(looked, scene_camera);
    viewer.run(0.5);
    viewer.set_clock({begun, true, 1});
    if (stop == Stop::own_camera) {
        fly(viewer, played);
    } else {
        viewer.run(played);
    }
    SceneTime const paused = stop == Stop::clip_end ? length : viewer.scene_time();
    viewer.set_time(paused);
    if (stop == Stop::seek) {
        viewer.run(0.5 * share(random));
        viewer.set_time(length * share(random));
    } else if (stop == Stop::resize) {
        viewer.run(0.5 * share(random));
        viewport = {viewport.width + 24, viewport.height - 10};
        viewer.resize(viewport);
    }
    PauseOutcome out;
    out.soon_shown = complete(viewer, out.is_complete);
    out.shown = viewer.picture();
    PausedViewer fresh(scene, viewport, options.rate, viewer.scene_time());
    fresh.look(viewer.camera(), scene_camera);
    bool fresh_is_complete = false;
    Picture const fresh_soon = complete(fresh, fresh_is_complete);
    out.is_complete = out.is_complete && fresh_is_complete;
    out.fresh = fresh.picture();
    out.differing = differing_pixels(out.shown, out.fresh);
    out.soon = mean_squared_error(out.soon_shown, out.fresh);
    out.fresh_soon = mean_squared_error(fresh_soon, out.fresh);
    return out;
}

json measure_pauses(std::span<std::filesystem::path const> scenes, std::size_t count, PauseOptions const& options,
                    std::filesystem::path const& charts) {
    FigureTable const table({{"scene", "/scene", -17},
                             {"pauses", "/pauses", 6},
                             {"complete", "/complete", 8},
                             {"equal", "/equal", 5},
                             {"differing pixels", "/differing_pixels", 16},
                             {"MSE soon", "/soon", 10, 5},
                             {"fresh", "/fresh_soon", 10, 5}});
    json rows = json::array();
    for (std::size_t s = 0; s < scenes.size(); ++s) {
        auto const scene = load_bench_scene(scenes[s]);
        std::size_t pauses = 0, complete = 0, equal = 0;
        int differing = 0;
        double soon = 0, fresh_soon = 0;
        json failures = json::array();
        for (std::size_t i = s; i < count; i += scenes.size()) {
            auto const stop = static_cast<Stop>((s + pauses) % stop_count);
            PauseOptions chosen = options;
            chosen.seed = options.seed + i;
            PauseOutcome const outcome = pause_once(*scene, stop, chosen);
            ++pauses;
            complete += outcome.is_complete ? 1 : 0;
            equal += outcome.differing == 0 ? 1 : 0;
            differing += outcome.differing;
            soon += outcome.soon;
            fresh_soon += outcome.fresh_soon;
            if (!charts.empty()) {
                std::filesystem::create_directories(charts);
                std::string const stem = scene->name + "-" + name_of(stop) + "-" + std::to_string(chosen.seed);
                write_png(charts / (stem + "-soon.png"), outcome.soon_shown);
                write_png(charts / (stem + "-shown.png"), outcome.shown);
                write_png(charts / (stem + "-fresh.png"), outcome.fresh);
            }
            if (outcome.differing > 0 || !outcome.is_complete) {
                failures.push_back(name_of(stop) + ", seed " + std::to_string(chosen.seed) + ": " +
                                   std::to_string(outcome.differing) + " pixels" +
                                   (outcome.is_complete ? "" : ", not complete"));
                std::printf("  %s\n", failures.back().get<std::string>().c_str());
            }
        }
        rows.push_back({{"scene", scene->name},
                        {"pauses", pauses},
                        {"complete", complete},
                        {"equal", equal},
                        {"differing_pixels", differing},
                        {"soon", soon / static_cast<double>(std::max<std::size_t>(pauses, 1))},
                        {"fresh_soon", fresh_soon / static_cast<double>(std::max<std::size_t>(pauses, 1))},
                        {"failures", failures}});
        table.print(rows.back());
    }
    return rows;
}

} // namespace framelet::bench
