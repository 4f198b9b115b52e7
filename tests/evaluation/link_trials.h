// How methods bear a link that changes: its rate falls and rises, it is slow, it stalls, it jitters. In: scene,
// reference, methods. Out: error, bytes and queueing over time, as JSON and as charts.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/reference.h"
#include "tests/evaluation/study.h"

namespace framelet::bench {

/// The run's seconds are divided into thirds: at their ends the rate changes, in the middle one the link stalls (for
/// two seconds at most). The delay is that of the run. Prints a line for each method.
nlohmann::json link_trials(BenchScene& scene, Reference const& reference, StudyOptions const& options);

} // namespace framelet::bench
