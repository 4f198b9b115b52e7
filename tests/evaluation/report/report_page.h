// Writes the report's page. In: figures. Out: text in Markdown.
#pragma once

#include <string>

#include "tests/evaluation/report/report_runs.h"

namespace framelet::bench {

/// The whole page. `command`: the command of the report, as a reader would type it.
std::string report_page(ReportFigures const& figures, ReportOptions const& options, StudyOptions const& study,
                        std::string const& command);

/// Writes RESULTS.md and the charts in pictures/ into `options.documents`. Throws InputError where it cannot.
void write_report(ReportFigures const& figures, ReportOptions const& options, StudyOptions const& study,
                  std::string const& command);

} // namespace framelet::bench
