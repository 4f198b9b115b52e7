// How methods bear a camera that turns while the link is long: the camera is the viewer's, and the server learns of it
// half a round trip late. In: scene, methods, link. Out: error against what the viewer's camera sees, and how late the
// shown picture is, for each speed and round trip; as JSON and as charts.
#pragma once

#include <span>

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/study.h"

namespace framelet::bench {

/// By how many reference times pictures are late: of all shifts up to `most` the one for which the mean error is least
/// between what was shown and what the reference showed so many times before. What stood still before the first
/// reference is as that one. The smallest of equals.
std::size_t picture_lag(std::span<Picture const> shown, std::span<Picture const> reference, std::size_t most);

/// The camera turns back and forth at several speeds, on top of what the scene does with it. Draws error against round
/// trip, one chart a speed, and pictures side by side.
nlohmann::json turn_study(BenchScene& scene, StudyOptions const& options);

} // namespace framelet::bench
