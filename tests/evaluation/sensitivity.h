// The verb `sensitivity`: measures how `tsar` answers to other templates of its error estimate ([Stephens 2011] section
// 7.3.2).
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/study.h"

namespace framelet::bench {

/// Tries five slopes of the template in space by five in time, the defaults in the middle; the steeper, the less energy
/// is tolerated at fine scales and the stronger the response. Where charts are asked for, draws two sheets of 5x5
/// pictures ([Stephens 2011] fig. 7.24 and 7.25): the picture shown at half the run, and the tiling then, brighter
/// where tiles are refreshed more often. From left to right less sensitive in space, from top to bottom in time.
nlohmann::json measure_sensitivity(StudyOptions const& study);

} // namespace framelet::bench
