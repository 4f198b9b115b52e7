// Runs many viewers of one server at once, as real programs: measures what each of them gets, and what one that has
// stopped reading costs the others.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/bench_scene.h"

namespace framelet::bench {

struct CrowdOptions {
    int viewers = 0; ///< 0: `live` runs one viewer and compares pictures
    bool stalled = false; ///< adds a second run, beside one more viewer that reads nothing
    Viewport viewport{1280, 720};
    double seconds = 4;
};

/// Prints a row for each viewer and one for all, and returns the figures. Throws ConnectionError where a program fails.
nlohmann::json measure_crowd(BenchScene const& scene, CrowdOptions const& options);

} // namespace framelet::bench
