// Draws charts of lines: error over time, error against cost. Values in, gnuplot scripts or files out.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/evaluation/charts/gnuplot.h"

namespace framelet::bench {

/// A line through points, in the order given. A point that is not finite leaves a gap.
struct Curve {
    std::string name; ///< name in the legend; fixes the colour (chart_style.h)
    std::vector<double> x;
    std::vector<double> y; ///< as many as `x`
    /// Lower and upper edge of a band around the line, as many as `x`; empty: there is none.
    std::vector<double> low{}, high{};
};

/// A vertical line with a word at its upper end.
struct Mark {
    double x = 0;
    std::string text;
};

/// Lines with a mark at each point, or these marks alone. On a logarithmic axis values of zero and less stand at its
/// lower end.
struct Curves {
    std::string title;
    std::string x_title; ///< with unit
    std::string y_title; ///< with unit
    bool log_x = false;
    bool log_y = false;
    bool points_only = false;
    std::vector<Curve> curves;
    std::vector<Mark> marks{};
};

struct ErrorSeries {
    std::string method;
    std::vector<double> seconds; ///< ascending
    std::vector<double> mse; ///< one for each of `seconds`; zero stands at the lower end of the axis
    std::vector<double> refreshes; ///< seconds at which a new picture was displayed; may be empty
};

/// Mean squared error against time, logarithmic, with a row of ticks below for each method that has refreshes
/// ([Stephens 2011] figs 7.8 and 7.14).
struct ErrorOverTime {
    std::string title;
    std::string y_title = "mean squared error";
    std::vector<ErrorSeries> series;
};

/// The drawing as text, the same for the same values. Throws InputError where a curve has no point to draw or not as
/// many x as y.
Plot plot_of(Curves const& chart);
Plot plot_of(ErrorOverTime const& chart);

/// Draws to `stem`.svg and `stem`.png.
template <class Chart>
void draw(Chart const& chart, std::filesystem::path const& stem) {
    render(plot_of(chart), stem);
}

} // namespace framelet::bench
