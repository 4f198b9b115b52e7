// framelet-bench limits: each stage beside its bare limit, measured in turn in one run, so that the ratios stand on a
// noisy machine too.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/bench_scene.h"

namespace framelet::bench {

struct LimitsOptions {
    Viewport viewport{1280, 720};
    int rounds = 9; ///< each stage and its limit in turn; medians are reported
};

/// Prints a table to stdout and returns the same figures.
nlohmann::json measure_limits(BenchScene& scene, LimitsOptions const& options);

} // namespace framelet::bench
