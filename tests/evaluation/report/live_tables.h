// Writes the report's tables of the real programs. In: what `measure_live` returns. Out: Markdown.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace framelet::bench {

/// Table with a row for each scene: framelet, the same without reprojection and the rival that errs least; then how
/// often framelet is best.
std::string live_table(std::vector<nlohmann::json> const& live);

/// The least of all rivals' figures in a scene, times `sign` (-1: the greatest is best), and the rival that has it;
/// infinite and empty where none ran.
std::pair<double, std::string> best_rival(nlohmann::json const& scene, char const* figure, double sign);

/// Table of the figures of virtual and wall clock for the same sessions, a row for each scene.
std::string clock_table(std::vector<nlohmann::json> const& clocks);

} // namespace framelet::bench
