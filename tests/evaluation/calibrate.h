// Measures what every stage costs on this machine: the table that the virtual clock runs on.
#pragma once

#include "tests/evaluation/bench_scene.h"
#include "tests/evaluation/cost_table.h"

namespace framelet::bench {

/// Measures on one thread; every cost is a median of `rounds` measurements. Poses the scene anew.
CostTable calibrate(BenchScene& scene, Viewport viewport, int rounds);

} // namespace framelet::bench
