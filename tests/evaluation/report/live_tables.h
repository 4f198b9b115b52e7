// The report's tables of the real programs. In: what `measure_live` returns. Out: Markdown.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace framelet::bench {

/// A row a scene: framelet, the same without reprojection and the rival that errs least; then how often it is best.
std::string live_table(std::vector<nlohmann::json> const& live);

/// The least of all rivals' figures in a scene, times `sign` (-1: the most is best), and whose that is; infinite and
/// empty where none ran.
std::pair<double, std::string> best_rival(nlohmann::json const& scene, char const* figure, double sign);

/// What virtual and wall clock say of the same sessions, a row a scene.
std::string clock_table(std::vector<nlohmann::json> const& clocks);

} // namespace framelet::bench
