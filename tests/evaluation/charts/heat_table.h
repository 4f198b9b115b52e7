// A table of ratios as coloured cells with their numbers: blue below 1, red above.
#pragma once

#include <string>
#include <vector>

#include "tests/evaluation/charts/charts.h"

namespace framelet::bench {

struct HeatTable {
    std::string title;
    std::string x_title;
    std::vector<std::string> columns;
    std::vector<std::string> rows; ///< from the top
    std::vector<std::vector<double>> values; ///< [row][column]; > 0; not finite: the cell stays empty
    double goal = 0; ///< what is above it is framed; 0: nothing is
};

/// Colours are logarithmic from 1/8 to 8, white at 1. InputError where the values are not as many as rows and columns,
/// or there are none. `draw` (charts.h) makes files of it.
Plot plot_of(HeatTable const& chart);

} // namespace framelet::bench
