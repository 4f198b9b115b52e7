#include "tests/evaluation/charts/charts.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "common/error.h"
#include "tests/evaluation/charts/chart_style.h"

namespace framelet::bench {
namespace {

using OptionalRange = std::optional<Range>; ///< none: a linear axis, which gnuplot scales

bool drawable(Curve const& curve, std::size_t i) {
    return std::isfinite(curve.x[i]) && std::isfinite(curve.y[i]);
}

void check(std::string const& title, std::vector<Curve> const& curves) {
    if (curves.empty()) {
        throw InputError("chart '" + title + "' has no curve");
    }
    for (Curve const& curve : curves) {
        if (curve.x.size() != curve.y.size()) {
            throw InputError("chart '" + title + "': curve '" + curve.name + "' has " + std::to_string(curve.x.size()) +
                             " x but " + std::to_string(curve.y.size()) + " y");
        }
        std::size_t i = 0;
        while (i < curve.x.size() && !drawable(curve, i)) {
            ++i;
        }
        if (i == curve.x.size()) {
            throw InputError("chart '" + title + "': curve '" + curve.name + "' has no point to draw");
        }
    }
}

/// Appends the values of the points that are drawn.
void add_values(std::vector<Curve> const& curves, std::vector<double> Curve::*axis, std::vector<double>& values) {
    for (Curve const& curve : curves) {
        for (std::size_t i = 0; i < (curve.*axis).size(); ++i) {
            if (drawable(curve, i)) {
                values.push_back((curve.*axis)[i]);
            }
        }
    }
}

Range range_of(std::vector<Curve> const& curves, std::vector<double> Curve::*axis) {
    std::vector<double> values;
    add_values(curves, axis, values);
    return log_range(values);
}

/// The range widened by a share of its decades on each side, so that marks at the ends are not cut.
Range widened(Range range, double share) {
    double const factor = std::pow(range.high / range.low, share);
    return {range.low / factor, range.high * factor};
}

std::string block_name(char const* what, std::size_t i) {
    return std::string("$") + what + std::to_string(i);
}

std::string axis_position(double value, OptionalRange const& range) {
    return number(range ? on_log_axis(value, *range) : value);
}

std::string data_block(std::string const& name, Curve const& curve, OptionalRange const& x, OptionalRange const& y) {
    std::string out = name + " << EOD\n";
    bool gap = true; // true where a gap, which is one blank line, has begun: two lines would begin another data set
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
        if (drawable(curve, i)) {
            out += axis_position(curve.x[i], x) + " " + axis_position(curve.y[i], y) + "\n";
            gap = false;
        } else if (!gap) {
            out += "\n";
            gap = true;
        }
    }
    return out + "EOD\n";
}

/// Adds a data block for each curve, numbered from `first` on, and returns the plot command without an end of line.
std::string add_lines(Plot& plot, std::vector<Curve> const& curves, OptionalRange const& x, OptionalRange const& y,
                      char const* with, std::size_t first = 0) {
    std::string command = "plot ";
    for (std::size_t i = 0; i < curves.size(); ++i) {
        std::string const block = block_name("curve", first + i);
        plot.data += data_block(block, curves[i], x, y);
        command += (i == 0 ? "" : ", \\\n  ") + block + " with " + with + " " + to_string(style_of(curves[i].name)) +
                   " title " + quoted(curves[i].name);
    }
    return command;
}

constexpr double mark_margin = 0.03; // margin on each side, as a share of a logarithmic axis

std::string log_axis_with_margin(std::string const& axis, Range const& range) {
    Range const wide = widened(range, mark_margin);
    return log_axis(axis, wide, wide.low, wide.high);
}

constexpr double row_height = 0.03; // height of the row of one method's refreshes, as a share of the chart's

/// Adds the data of the rows of refreshes and returns the plot commands for them, on a second y axis from 0 to 1.
std::string add_refreshes(Plot& plot, std::vector<ErrorSeries> const& series) {
    std::string command;
    std::size_t row = 0;
    for (std::size_t i = 0; i < series.size(); ++i) {
        if (series[i].refreshes.empty()) {
            continue;
        }
        std::string const block = block_name("refresh", i);
        std::string const low = number((static_cast<double>(row) + 0.2) * row_height);
        plot.data += block + " << EOD\n";
        for (double const seconds : series[i].refreshes) {
            plot.data += number(seconds) + " " + low + "\n";
        }
        plot.data += "EOD\n";
        command += ", \\\n  " + block + " using 1:2:(0):(" + number(0.6 * row_height) +
                   ") axes x1y2 with vectors nohead lw 1 lc rgb '" + style_of(series[i].method).color + "' notitle";
        ++row;
    }
    return command;
}

/// Adds a chart's data, blocks numbered from `first` on, and its commands; `look` are some that follow the common ones.
void add_curves(Plot& plot, Curves const& chart, std::size_t first, std::string const& look) {
    check(chart.title, chart.curves);
    OptionalRange const x = chart.log_x ? OptionalRange(range_of(chart.curves, &Curve::x)) : std::nullopt;
    OptionalRange const y = chart.log_y ? OptionalRange(range_of(chart.curves, &Curve::y)) : std::nullopt;
    plot.commands += common_look(chart.title) + look + axis_title("x", chart.x_title) + axis_title("y", chart.y_title);
    plot.commands += x ? log_axis_with_margin("x", *x) : "set xrange [*:*]\n";
    plot.commands += y ? log_axis_with_margin("y", *y) : "set yrange [*:*]\n";
    plot.commands += add_lines(plot, chart.curves, x, y, "linespoints", first) + "\n";
}

} // namespace

Plot plot_of(Curves const& chart) {
    Plot plot;
    add_curves(plot, chart, 0, "");
    return plot;
}

Plot plot_of(Panels const& chart) {
    if (chart.panels.empty() || chart.columns < 1) {
        throw InputError("there is no panel to draw");
    }
    int const count = static_cast<int>(chart.panels.size());
    int const rows = (count + chart.columns - 1) / chart.columns;
    Plot plot;
    plot.width = 340 * chart.columns;
    plot.height = 280 * rows;
    plot.commands = "set multiplot layout " + std::to_string(rows) + "," + std::to_string(chart.columns) + "\n";
    std::size_t first = 0;
    for (Curves const& panel : chart.panels) {
        add_curves(plot, panel, first, first == 0 ? "set key inside right bottom font ',9'\n" : "unset key\n");
        first += panel.curves.size();
    }
    plot.commands += "unset multiplot\n";
    return plot;
}

Plot plot_of(Arrows const& chart) {
    if (chart.arrows.empty()) {
        throw InputError("chart '" + chart.title + "' has no arrow");
    }
    Plot plot;
    plot.data = "$arrows << EOD\n";
    for (Arrow const& arrow : chart.arrows) {
        plot.data += number(arrow.from[0]) + " " + number(arrow.from[1]) + " " + number(arrow.to[0] - arrow.from[0]) +
                     " " + number(arrow.to[1] - arrow.from[1]) + " " + number(arrow.to[0]) + " " + number(arrow.to[1]) +
                     " \"" + arrow.name + "\"\n";
    }
    plot.data += "EOD\n";
    std::string const own = style_of("framelet").color;
    plot.commands = "set termoption noenhanced\n" + common_look(chart.title) +
                    "unset key\nset offsets 0, graph 0.15, graph 0.05, graph 0.05\n" + axis_title("x", chart.x_title) +
                    axis_title("y", chart.y_title) +
                    "plot $arrows using 1:2:3:4 with vectors head filled lw 1.5 lc rgb '#999999', \\\n"
                    "  '' using 1:2 with points pt 7 ps 0.8 lc rgb '#56b4e9', \\\n"
                    "  '' using 5:6 with points pt 7 ps 1.1 lc rgb '" +
                    own +
                    "', \\\n"
                    "  '' using 5:6:7 with labels left offset 0.8,0 font ',9'\n";
    return plot;
}

Plot plot_of(ErrorOverTime const& chart) {
    std::vector<Curve> curves;
    double first = INFINITY, last = -INFINITY;
    std::size_t rows = 0;
    for (ErrorSeries const& series : chart.series) {
        curves.push_back({series.method, series.seconds, series.mse});
        for (double const seconds : series.seconds) {
            first = std::min(first, seconds);
            last = std::max(last, seconds);
        }
        rows += series.refreshes.empty() ? 0 : 1;
    }
    check(chart.title, curves);
    Range const y = widened(range_of(curves, &Curve::y), mark_margin);
    double const rows_share = row_height * static_cast<double>(rows);
    Range const with_rows{y.low / std::pow(y.high / y.low, rows_share / (1 - rows_share)), y.high};

    Plot plot;
    plot.commands = common_look(chart.title) + axis_title("x", "time [s]") + axis_title("y", chart.y_title);
    plot.commands += log_axis("y", with_rows, y.low, y.high);
    if (last > first) {
        plot.commands += "set xrange [" + number(first) + ":" + number(last) + "]\n";
    }
    plot.commands += "set y2range [0:1]\n";
    if (rows > 0) {
        plot.commands += "set label 'refreshes' at graph -0.01, graph " + number(rows_share / 2) +
                         " right font ',9' textcolor rgb '#666666'\n";
    }
    plot.commands += add_lines(plot, curves, std::nullopt, y, "lines");
    plot.commands += add_refreshes(plot, chart.series) + "\n";
    return plot;
}

} // namespace framelet::bench
