// Draws the report's three charts. In: figures. Out: pictures.
#pragma once

#include <filesystem>
#include <vector>

#include "tests/evaluation/charts/charts.h"
#include "tests/evaluation/report/report_runs.h"

namespace framelet::bench {

/// An arrow for each scene of the real programs, from the best rival's PSNR and pictures a second to framelet's.
Arrows live_chart(std::vector<nlohmann::json> const& live);
/// A panel for each scene: PSNR of each method over the link's rate, and one over its round trip.
Panels links_chart(std::vector<LinkRun> const& links, ReportOptions const& options);
/// PSNR of each method's mean error over the number of cores.
Curves cores_chart(std::vector<CoreRun> const& runs);

/// Draws those of which there are figures as PNG files: live, links, cores.
void draw_report_charts(ReportFigures const& figures, ReportOptions const& options);

} // namespace framelet::bench
