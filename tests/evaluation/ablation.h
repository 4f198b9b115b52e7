// `ablation`: every part of `framelet` left out in turn. Out: what the error, the bytes and the server's work become,
// as multiples of those of the whole.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/study.h"

namespace framelet::bench {

/// Each of the scenes, twice: without a limit and over 5 Mbit/s with 20 ms each way. Prints a table and returns the
/// same figures. Of `study`, methods and link are not looked at.
nlohmann::json measure_ablation(StudyOptions const& study);

} // namespace framelet::bench
