// Methods against the reference, on the virtual clock: error over time, cost, and the ratio to whole frames at equal
// cost.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/charts/charts.h"
#include "tests/evaluation/measures/measures.h"
#include "tests/evaluation/reference.h"
#include "tests/evaluation/run.h"

namespace framelet::bench {

/// What one method showed and spent.
struct MethodRecord {
    std::string method;
    RivalParts rivals; ///< as it was run
    RunResult run;
    std::vector<Measures> measures; ///< one a reference time
    std::vector<double> ages; ///< seconds, likewise
    std::vector<double> unsteadiness; ///< likewise, over the time and the two before it; 0 for the first two
    Picture sample; ///< what it showed at the middle reference time
};

struct Comparison {
    std::string scene;
    RunParameters parameters;
    double machine = 1;
    double turn = 0; ///< of the camera, degrees a second
    std::vector<MethodRecord> records;
    Picture reference_sample;
};

/// One method on a machine of this speed; measures are taken in parallel to the run. `reference` must have a picture
/// for each reference time. Where the parameters leave a choice to a rival, it is run with each, and the record is the
/// one of the least mean MSE.
MethodRecord record_method(BenchScene& scene, Reference const& reference, std::string const& method,
                           RunParameters const& parameters, double machine, CostTable const& costs);

/// Runs the methods one after the other, on the machine that the parameters state.
Comparison compare_methods(BenchScene& scene, Reference const& reference, std::vector<std::string> const& methods,
                           RunParameters const& parameters, CostTable const& costs);

/// MSE(method) / MSE(framed) at each reference time, of the same run. Where both are exact the ratio is 1.
std::vector<double> error_ratios(MethodRecord const& method, MethodRecord const& framed);
/// The record of `framed`, or null.
MethodRecord const* find_framed(Comparison const& comparison);

/// For a chart of error over time.
ErrorSeries error_series(MethodRecord const& record, RunParameters const& parameters);

double mean_mse(MethodRecord const& record);
double mean_unsteadiness(MethodRecord const& record);

nlohmann::json to_json(Comparison const& comparison);
void print(Comparison const& comparison);

} // namespace framelet::bench
