// Compares methods with the reference on the virtual clock. In: scene, methods, machine. Out: error over time, cost,
// and the ratio to whole frames at equal cost.
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

/// Record of what one method showed and spent.
struct MethodRecord {
    std::string method;
    RivalParts rivals; ///< parts and choices with which it was run
    RunResult run;
    std::vector<Measures> measures; ///< one for each reference time
    std::vector<double> ages; ///< mean age of the picture's pixels, seconds, one for each reference time
    /// One for each reference time, over it and the two before it; 0 for the first two.
    std::vector<double> unsteadiness;
    Picture sample; ///< picture shown at the middle reference time
};

struct Comparison {
    std::string scene;
    RunParameters parameters;
    double machine = 1;
    double turn = 0; ///< turning of the camera, degrees a second
    std::vector<MethodRecord> records;
    Picture reference_sample;
};

/// Runs one method on a machine that is `machine` times slower than the calibrated one, and measures its pictures in
/// parallel to the run. `reference` must have a picture for each reference time. Where the parameters leave a choice to
/// a rival, it is run with each choice, and the record is that of the least mean MSE.
MethodRecord record_method(BenchScene& scene, Reference const& reference, std::string const& method,
                           RunParameters const& parameters, double machine, CostTable const& costs);

/// Runs the methods one after the other, on the machine that the parameters state.
Comparison compare_methods(BenchScene& scene, Reference const& reference, std::vector<std::string> const& methods,
                           RunParameters const& parameters, CostTable const& costs);

/// MSE(method) / MSE(framed) at each reference time; both records are of the same run. 1 where both are exact.
std::vector<double> error_ratios(MethodRecord const& method, MethodRecord const& framed);
/// The record of `framed`, or null.
MethodRecord const* find_framed(Comparison const& comparison);

/// The record as a series for a chart of error over time.
ErrorSeries error_series(MethodRecord const& record, RunParameters const& parameters);

double mean_mse(MethodRecord const& record);
double mean_unsteadiness(MethodRecord const& record);

nlohmann::json to_json(Comparison const& comparison);
void print(Comparison const& comparison);

} // namespace framelet::bench
