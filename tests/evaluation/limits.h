// framelet-bench limits: each stage beside its bare limit, measured in turn in one run, so that the ratios stand on a
// noisy machine too.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/bench_scene.h"

namespace framelet::bench {

struct LimitsOptions {
    Viewport viewport{1280, 720};
    int rounds = 9; ///< each stage and its limit in turn; medians are reported, of stages the fastest round too
};

/// Prints a table to stdout and returns the same figures. Of a stage: `ns` (median) and `fastest_ns` for each sample or
/// pixel, `memcpy_ns` (median) of the same bytes and `times_memcpy`, the median of the rounds' quotients.
nlohmann::json measure_limits(BenchScene& scene, LimitsOptions const& options);

} // namespace framelet::bench
