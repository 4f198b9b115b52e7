// Methods against the reference, on the virtual clock: error over time, cost, and the ratio to whole frames at equal
// cost.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/measures/measures.h"
#include "tests/evaluation/reference.h"
#include "tests/evaluation/run.h"

namespace framelet::bench {

/// What one method showed and spent.
struct MethodRecord {
    std::string method;
    RunResult run;
    std::vector<Measures> measures; ///< one a reference time
    std::vector<double> ages; ///< seconds, likewise
    Picture sample; ///< what it showed at the middle reference time
};

struct Comparison {
    std::string scene;
    RunParameters parameters;
    double machine = 1;
    double spatial_slope = 0; ///< of the power spectrum (004 fig. 1.3), mean over reference pictures
    std::vector<MethodRecord> records;
    Picture reference_sample;
};

/// Runs the methods one after the other; measures are taken in parallel to the runs.
Comparison compare_methods(BenchScene& scene, Reference const& reference, std::vector<std::string> const& methods,
                           RunParameters const& parameters, CostTable const& costs);

/// MSE(method) / MSE(framed) at each reference time, of the same run. Where both are exact the ratio is 1.
std::vector<double> error_ratios(MethodRecord const& method, MethodRecord const& framed);
/// The record of `framed`, or null.
MethodRecord const* find_framed(Comparison const& comparison);

double mean_mse(MethodRecord const& record);

nlohmann::json to_json(Comparison const& comparison);
void print(Comparison const& comparison);

} // namespace framelet::bench
