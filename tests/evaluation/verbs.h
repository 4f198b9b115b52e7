// The verbs that run on the virtual clock. Each prints what it found, draws charts where it is told to, returns
// figures.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/comparison.h"

namespace framelet::bench {

/// What every such verb is told.
struct StudyOptions {
    std::vector<std::string> methods;
    RunParameters run;
    int samples_per_side = 3; ///< of the reference
    std::filesystem::path reference_cache = default_reference_cache();
    std::filesystem::path charts; ///< folder; empty: none are drawn
    CostTable costs;
};

/// One run: every method against the reference; error over time, and the pictures side by side.
nlohmann::json compare(BenchScene& scene, StudyOptions const& options);

/// Error against the server's work (machines of other speed), against bytes (links of other rate) and against delay.
nlohmann::json pareto(BenchScene& scene, StudyOptions const& options);

/// Error and delay against the link's rate and round trip, and through a stall.
nlohmann::json link_study(BenchScene& scene, StudyOptions const& options);

/// Renders what the other verbs compare with.
nlohmann::json prepare_reference(BenchScene& scene, StudyOptions const& options);

} // namespace framelet::bench
