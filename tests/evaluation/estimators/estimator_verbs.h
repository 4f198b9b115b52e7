// framelet-bench estimators: error estimators against the oracle of the ideal density.
#pragma once

#include <filesystem>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/estimators/observations.h"

namespace CLI {
class App;
}

namespace framelet::bench {

struct EstimatorStudy {
    std::vector<std::filesystem::path> scenes;
    ObservationOptions observation;
    std::filesystem::path charts; ///< folder; empty: none are drawn
    bool quick = false; ///< the first two scenes, a few places of each
};

void add_estimator_options(CLI::App& verb, EstimatorStudy& study);

/// Cost of each estimator and its agreement with the oracle, with the templates that it comes with.
nlohmann::json compare_estimators(EstimatorStudy const& study);

} // namespace framelet::bench
