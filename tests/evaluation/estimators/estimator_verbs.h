// framelet-bench estimators: error estimators against the oracle of the ideal density.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/estimators/observations.h"
#include "tests/evaluation/study.h"

namespace framelet::bench {

/// Cost of each estimator and its agreement with the oracle, with the templates that it comes with. Of `study`, scenes
/// and seed count. `quick`: the first two scenes.
nlohmann::json compare_estimators(StudyOptions const& study, ObservationOptions const& observation, bool quick);

} // namespace framelet::bench
