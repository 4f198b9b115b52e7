// The verbs that run on the virtual clock. Each prints what it found, draws charts where it is told to, returns
// figures.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/study.h"

namespace framelet::bench {

/// One run: every method against the reference; error over time, and the pictures side by side.
nlohmann::json compare(BenchScene& scene, StudyOptions const& options);

/// Error against the server's work (machines of other speed), against bytes (links of other rate) and against delay.
nlohmann::json pareto(BenchScene& scene, StudyOptions const& options);

/// Error and delay against the link's rate and round trip, and through a stall.
nlohmann::json link_study(BenchScene& scene, StudyOptions const& options);

/// Renders what the other verbs compare with.
nlohmann::json prepare_reference(BenchScene& scene, StudyOptions const& options);

} // namespace framelet::bench
