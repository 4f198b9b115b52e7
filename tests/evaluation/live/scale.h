// What workers buy: measured with the real programs on this machine, and what a cluster would come to by the costs that
// were measured. In: a scene whose light is by paths. Out: rates, costs, and what ends the growth.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "common/camera.h"
#include "tests/evaluation/cost_table.h"

namespace framelet::bench {

/// What a sample of one path costs, in seconds of a processor.
struct WorkCosts {
    double path = 0; ///< where it is traced
    double home = 0; ///< at the server, by any of its processors: surfaces, sums, plan, codec
    double network = 0; ///< at the server, by the one thread that has the connections, of a path from a worker
    double serial = 0; ///< at the server, by one thread: what of planning, learning and coding is not parallel
};

/// Machines of the same kind: the server's, and those of its workers.
struct Cluster {
    int ranks = 0; ///< workers
    int cores = 32; ///< of each, and of the server
    double bits_per_second = 1e10; ///< of the server's link
};

struct Growth {
    double samples_per_second = 0;
    double efficiency = 0; ///< of what all workers could trace
    std::string end; ///< what it is that ends it
};

/// A path that a worker answers with, its order included.
inline constexpr double bytes_a_path = 13;

/// Samples that a server shows a second by its workers' paths alone: the least of what each part could.
Growth growth(WorkCosts const& costs, Cluster const& cluster);

struct ScaleOptions {
    std::filesystem::path scene;
    Viewport viewport{640, 360};
    double seconds = 6; ///< of each run
    std::vector<int> workers{0, 1, 2, 3, 4};
    std::filesystem::path charts; ///< folder; empty: none are drawn
    CostTable costs; ///< by which sessions run on the virtual clock
};

/// Prints and returns what runs with so many workers of one thread each have measured, beside a server of one thread,
/// and what they come to on a cluster. Throws ConnectionError where a program fails.
nlohmann::json measure_scale(ScaleOptions const& options);

} // namespace framelet::bench
