// The report's tables of the real programs. In: what `measure_live` returns. Out: Markdown.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace framelet::bench {

/// A row a scene: framelet, the same without reprojection and the rival that errs least; then how often it is best.
std::string live_table(std::vector<nlohmann::json> const& live);

/// What virtual and wall clock say of the same sessions, a row a scene.
std::string clock_table(std::vector<nlohmann::json> const& clocks);

} // namespace framelet::bench
