// Measures the cost of response and selection for a server of a moving picture.
#pragma once

#include "tests/evaluation/bench_scene.h"

namespace framelet::bench {

/// CPU seconds of one thread, and what they were spent on.
struct ResponseCost {
    double plan = 0, learn = 0;
    std::size_t cycles = 0;
    std::size_t samples = 0; ///< samples of all framelets
    std::size_t regions = 0;
};

/// Serves `seconds` of the moving scene to a viewer whose server makes `samples_per_second`, with cycles of the default
/// length, on the calling thread. The scene stands at its start afterwards.
ResponseCost response_cost(BenchScene& scene, Viewport viewport, double samples_per_second, double seconds);

} // namespace framelet::bench
