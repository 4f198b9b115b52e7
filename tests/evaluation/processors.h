// The verb `limits --threads`: what one viewer's server takes of each stage with so many threads, how much of that no
// further processor shortens, and what more of them would come to. A moving session on the virtual clock of a machine
// that is as fast as told, so that batches are as large as such a machine's, clocked as it runs here.
#pragma once

#include <filesystem>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/bench_scene.h"
#include "tests/evaluation/run.h"

namespace framelet::bench {

/// What a stage takes for a sample, seconds: what one thread does alone, and what all share.
struct StageCost {
    double serial = 0, parallel = 0;
};

struct ServerCosts {
    StageCost plan, render, learn, encode;

    /// What one thread does alone for a sample, seconds: planning, then finishing beside the rendering of the next one.
    double serial() const { return plan.serial + learn.serial + encode.serial; }
};

/// The stage's cost by what it took with so many threads: least squares, neither part below 0. At least two different
/// counts, and as many times.
StageCost stage_cost(std::vector<int> const& threads, std::vector<double> const& seconds);

/// Seconds a sample with so many threads. Of many, some learn and encode a batch while the next one renders, as in
/// `SessionLoop`; planning is by itself, and of rendering only the parallel part counts.
double seconds_with(ServerCosts const& costs, int threads);

/// Clocks sessions with these numbers of threads, two different ones at least and none above that of the processors,
/// and prints what each stage takes. Rendering is taken to be all parallel.
/// `run.times` is not used; `rows`, unless null, gets the figures.
ServerCosts measure_server(BenchScene& scene, RunParameters const& run, CostTable const& costs,
                           std::vector<int> const& threads, nlohmann::json* rows = nullptr);

/// Prints and returns what each stage takes with these numbers of threads, and draws what others come to into the
/// folder `charts`, unless that is empty.
nlohmann::json measure_processors(BenchScene& scene, RunParameters const& run, CostTable const& costs,
                                  std::vector<int> const& threads, std::filesystem::path const& charts);

} // namespace framelet::bench
