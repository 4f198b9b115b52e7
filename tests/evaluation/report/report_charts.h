// Draws the report's charts. In: figures. Out: pictures.
#pragma once

#include <filesystem>
#include <vector>

#include "tests/evaluation/charts/charts.h"
#include "tests/evaluation/report/report_runs.h"

namespace framelet::bench {

/// Geometric mean and quartiles of positive numbers.
struct Spread {
    double low = 0, mean = 0, high = 0;
};
Spread spread_of(std::vector<double> values);

/// Chart of error over the reference's own noise against the machine's speed: a curve for each method, over all scenes.
Curves speed_chart(ReportFigures const& figures);

/// Draws that chart, those of FLIP and unsteadiness likewise, of error against what links carry, and of the real
/// programs, as PNG files.
void draw_report_charts(ReportFigures const& figures, std::filesystem::path const& folder);

} // namespace framelet::bench
