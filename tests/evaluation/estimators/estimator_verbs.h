// The verb `estimators`: compares error estimators with the oracle of the ideal density.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/estimators/observations.h"
#include "tests/evaluation/study.h"

namespace framelet::bench {

/// Measures the cost of each estimator and its agreement with the oracle, with the templates that it comes with. Of
/// `study` only scenes and seed count. `quick`: takes the first two scenes only.
nlohmann::json compare_estimators(StudyOptions const& study, ObservationOptions const& observation, bool quick);

} // namespace framelet::bench
