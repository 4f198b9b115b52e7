// The report's charts. In: figures. Out: pictures.
#pragma once

#include <filesystem>
#include <vector>

#include "tests/evaluation/charts/charts.h"
#include "tests/evaluation/report/report_runs.h"

namespace framelet::bench {

/// Of positive numbers: geometric mean and quartiles.
struct Spread {
    double low = 0, mean = 0, high = 0;
};
Spread spread_of(std::vector<double> values);

/// Error over the reference's own noise against the machine's speed: a curve a method, over all scenes.
Curves speed_chart(ReportFigures const& figures);

/// That one, FLIP and unsteadiness likewise, error against what links carry, and the real programs: as PNG files.
void draw_report_charts(ReportFigures const& figures, std::filesystem::path const& folder);

} // namespace framelet::bench
