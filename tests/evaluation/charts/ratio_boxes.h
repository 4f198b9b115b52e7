// Box plots of the error ratio of each run, a panel a scene, with the share of suitable times beside the published one
// (004 eq. 7.2, figs 7.10 to 7.13, Table 7.2).
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tests/evaluation/charts/charts.h"

namespace framelet::bench {

/// Percentiles of one run's ratios, interpolated linearly between neighbours, and its suitability.
struct RatioSummary {
    double p5 = 0, p25 = 0, p50 = 0, p75 = 0, p95 = 0;
    double suitable = 0; ///< per cent of the times at which the ratio is <= 1
};

/// `ratios`: MSE(adaptive) / MSE(nonadaptive) at each time, >= 0; infinite where the nonadaptive error alone is zero.
/// InputError where there is none, or one is negative or not a number.
RatioSummary summarise_ratios(std::span<double const> ratios);

struct RatioRun {
    std::string label; ///< below the box: "0", "32 / 256"
    std::vector<double> ratios; ///< as for `summarise_ratios`
    std::optional<double> published; ///< per cent suitable in Table 7.2
};

struct RatioScene {
    std::string name;
    std::vector<RatioRun> runs;
};

struct RatioBoxes {
    std::string title;
    std::string x_title = "run";
    std::string y_title = "error ratio";
    std::vector<RatioScene> scenes;
};

/// Boxes from the 25th to the 75th percentile, whiskers from the 5th to the 95th, logarithmic, one range for all
/// scenes. `draw` (charts.h) makes files of it.
Plot plot_of(RatioBoxes const& chart);

} // namespace framelet::bench
