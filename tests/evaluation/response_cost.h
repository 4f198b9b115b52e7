// framelet-bench response: what response, tiling and selection cost beside rendering, for pictures of all sizes.
#pragma once

#include <filesystem>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/bench_scene.h"

namespace framelet::bench {

/// CPU seconds of one thread that serves a moving picture, and what they were spent on.
struct ResponseCost {
    double plan = 0, learn = 0; ///< the response: everything that decides what is rendered
    double render = 0, encode = 0; ///< probes included; tone curve included
    std::size_t cycles = 0;
    std::size_t batches = 0;
    std::size_t samples = 0; ///< of framelets
    std::size_t places = 0;

    double response() const { return plan + learn; }
    double share() const { return response() / (response() + render + encode); }
};

/// Serves `seconds` of the moving scene to a viewer whose server makes `samples_per_second`, with cycles of the default
/// length, on the calling thread. The scene stands at its start afterwards.
ResponseCost response_cost(BenchScene& scene, Viewport viewport, double samples_per_second, double seconds);

struct ResponseStudy {
    std::vector<int> sides{256, 512, 1024, 2048, 4096}; ///< of square pictures, pixels
    double seconds = 2;
    std::filesystem::path charts; ///< folder; empty: none are drawn
};

/// All sizes at the rate of samples that all of this machine's processors reach: the same samples, spread over more
/// pixels. The work is done on one thread, so that nothing but work is counted. Prints a table and returns the same
/// figures.
nlohmann::json measure_response(BenchScene& scene, ResponseStudy const& study);

} // namespace framelet::bench
