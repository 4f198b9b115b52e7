// The verb `limits`: measures the whole server beside its bare limit, in turn in one run, so that the ratio stands on a
// noisy machine too. Costs of single stages are measured by `calibrate`.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/bench_scene.h"

namespace framelet::bench {

/// Prints and returns medians of `rounds` rounds: samples a second of the whole server, its socket included, and of
/// Embree and shading alone on the very same framelets.
nlohmann::json measure_limits(BenchScene& scene, Viewport viewport, int rounds);

} // namespace framelet::bench
