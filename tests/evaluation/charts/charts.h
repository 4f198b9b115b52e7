// Draws charts of lines: error over time, error against cost. Values in, gnuplot scripts or files out.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/evaluation/charts/gnuplot.h"

namespace framelet::bench {

/// A line through points, in the order given, with a mark at each. A point that is not finite leaves a gap.
struct Curve {
    std::string name; ///< name in the legend; fixes the colour (chart_style.h)
    std::vector<double> x;
    std::vector<double> y; ///< as many as `x`
};

/// On a logarithmic axis values of zero and less stand at its lower end.
struct Curves {
    std::string title;
    std::string x_title; ///< with unit
    std::string y_title; ///< with unit
    bool log_x = false;
    bool log_y = false;
    std::vector<Curve> curves;
};

/// Charts beside each other, row by row.
struct Panels {
    int columns = 1;
    std::vector<Curves> panels; ///< at least one; the legend is that of the first
};

/// A change of two values, with its name at the head.
struct Arrow {
    std::string name;
    std::array<double, 2> from, to; ///< x and y
};

struct Arrows {
    std::string title, x_title, y_title; ///< axes with unit
    std::vector<Arrow> arrows; ///< at least one
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

/// The drawing as text, the same for the same values. Throws InputError where a chart has nothing to draw, or a curve
/// no point or not as many x as y.
Plot plot_of(Curves const& chart);
Plot plot_of(Panels const& chart);
Plot plot_of(Arrows const& chart);
Plot plot_of(ErrorOverTime const& chart);

/// Draws to `stem`.svg and `stem`.png.
template <class Chart>
void draw(Chart const& chart, std::filesystem::path const& stem) {
    render(plot_of(chart), stem);
}

} // namespace framelet::bench
