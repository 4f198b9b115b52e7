// The verb `ablation`: leaves out every part of `framelet` in turn. In: scenes, the parts. Out: error, bytes and the
// server's work without each part, as multiples of those of the whole.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/study.h"

namespace framelet::bench {

/// Names of the parts that can be left out.
std::vector<std::string> ablation_parts();

/// Runs each of the scenes twice: without a limit, and over the link of `study` or, where that has no limit, over 5
/// Mbit/s with 20 ms each way. `without`: the parts to leave out; empty: each of them in turn. Prints a table and
/// returns the same figures. Ignores the methods of `study`.
nlohmann::json measure_ablation(StudyOptions const& study, std::vector<std::string> const& without);

} // namespace framelet::bench
