// Options that every verb of the virtual clock takes, and a scene made ready for it.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tests/evaluation/cost_table.h"
#include "tests/evaluation/reference.h"
#include "tests/evaluation/run.h"

namespace framelet::bench {

/// How the server knows what happens in a scene at once: from the scene's tracks; not before the clock is set
/// (`unannounced_settings`); from tracks that do not say so (`Clips::baked`).
enum class Events { announced, set, baked };

struct StudyOptions {
    std::vector<std::filesystem::path> scenes; ///< files
    double turn = 0; ///< turning of the camera, degrees a second (`CameraTurn`)
    Events events = Events::announced;
    std::filesystem::path camera; ///< camera file by which the viewer flies, by scene time; empty: none
    double orthographic_height = 0; ///< as in BenchScene
    bool sees_events = false; ///< each scene's run begins where `window_start` says, and not at `run.start`
    std::vector<std::string> methods;
    RunParameters run;
    int samples_per_side = 3; ///< samples along a side of the reference's pixel
    std::filesystem::path reference_cache = default_reference_cache();
    std::filesystem::path charts; ///< folder for charts; empty: none are drawn
    CostTable costs;
};

/// The reference for such a run; renders the pictures of it that the cache lacks.
Reference reference_of(BenchScene& scene, StudyOptions const& options);

/// A scene with all that its runs need.
struct Subject {
    std::unique_ptr<BenchScene> scene;
    RunParameters run; ///< parameters, beginning where the scene's window does
    Reference reference;
    double machine; ///< how many times slower the machine is than the calibrated one
};

/// Loads the scene, renders its reference. Throws InputError.
Subject prepare(std::filesystem::path const& file, StudyOptions const& options);

} // namespace framelet::bench
