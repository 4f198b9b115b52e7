// `ablation`: every part of `framelet` left out in turn. Out: what the error, the bytes and the server's work become,
// as multiples of those of the whole.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/study.h"

namespace framelet::bench {

/// Names of the parts.
std::vector<std::string> ablation_parts();

/// Each of the scenes, twice: without a limit and over the link of `study`, or where that has no limit over 5 Mbit/s
/// with 20 ms each way. `without`: which parts are left out; none: each of them. Prints a table and returns the same
/// figures. Methods are not looked at.
nlohmann::json measure_ablation(StudyOptions const& study, std::vector<std::string> const& without);

} // namespace framelet::bench
