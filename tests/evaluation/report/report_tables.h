// Writes the report's tables. In: its figures. Out: Markdown; what is lost is in bold.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tests/evaluation/report/report_runs.h"

namespace framelet::bench {

/// The least of all rivals' figures in a scene of the real programs, times `sign` (-1: the greatest is best), and the
/// rival that has it; infinite and empty where none ran.
std::pair<double, std::string> best_rival(nlohmann::json const& scene, char const* figure, double sign);

/// Geometric mean over scenes of a method's mean squared error with so many cores; 0 where there is no run.
double mean_error(std::vector<CoreRun> const& runs, std::string const& method, int cores);

/// A row for each goal: how many scenes reach it, the median and the worst.
std::string goals_table(ReportFigures const& figures);
/// A row for each scene: framelet beside the rival that errs least.
std::string live_table(std::vector<nlohmann::json> const& live);
/// A row for each scene and link: PSNR of each method.
std::string links_table(std::vector<LinkRun> const& links);
/// A row for each scene: framelet's error over the best rival's, with each number of cores.
std::string cores_table(std::vector<CoreRun> const& runs);

} // namespace framelet::bench
