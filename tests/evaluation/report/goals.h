// Compares the project with the goals that it has set itself. In: the report's figures. Out: a table in Markdown.
#pragma once

#include <string>
#include <vector>

#include "tests/evaluation/report/report_runs.h"

namespace framelet::bench {

struct Goal {
    std::string what, goal, figure; ///< texts of the table
    bool met = false; ///< a goal that was not measured is not met
};

/// Each goal, in the order of the table.
std::vector<Goal> goals_of(ReportFigures const& figures);

std::string goals_table(std::vector<Goal> const& goals);

/// Bits that `framelet` sends over those that `rival` does for the same error, in one scene over links; the error is in
/// the middle of those that both reach. Infinite where `framelet` never errs as little as `rival` at its worst; where
/// it always errs less: its fewest bits over those with which `rival` is at its best, no less than the truth. NaN where
/// one has no runs.
double bits_at_equal_error(std::vector<ReportRun> const& linked, std::string const& scene, std::string const& rival);

} // namespace framelet::bench
