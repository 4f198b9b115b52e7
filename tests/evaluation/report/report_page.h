// The report's page and charts. In: figures. Out: text in Markdown, and pictures.
#pragma once

#include <string>
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
/// The same against what is sent, over links of several rates.
Curves bits_chart(ReportFigures const& figures);
/// FLIP and unsteadiness against the machine's speed.
Curves flip_chart(ReportFigures const& figures);
Curves steadiness_chart(ReportFigures const& figures);

/// `command`: as a reader would type it.
std::string report_page(ReportFigures const& figures, ReportOptions const& options, StudyOptions const& study,
                        std::string const& command);

/// Writes RESULTS.md and pictures/ into `options.documents`. Throws InputError where it cannot.
void write_report(ReportFigures const& figures, ReportOptions const& options, StudyOptions const& study,
                  std::string const& command);

} // namespace framelet::bench
