#include "tests/evaluation/charts/heat_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/error.h"
#include "tests/evaluation/charts/chart_style.h"

namespace framelet::bench {
namespace {

constexpr int cell_width = 72, cell_height = 26; // pixels
constexpr int beside = 260, around = 130; // pixels that are no cells
constexpr double octaves = 3; // each way, to the strongest colour

void check(HeatTable const& chart) {
    bool const complete =
        !chart.rows.empty() && !chart.columns.empty() && chart.values.size() == chart.rows.size() &&
        std::ranges::all_of(chart.values, [&](auto const& row) { return row.size() == chart.columns.size(); });
    if (!complete) {
        throw InputError("chart '" + chart.title + "' needs a value for each of its rows and columns");
    }
}

std::string two_digits(double value) {
    char text[32];
    std::snprintf(text, sizeof(text), value < 9.995 ? "%.2f" : "%.0f", value);
    return text;
}

std::string marks(char const* axis, std::vector<std::string> const& names) {
    std::string list;
    for (std::size_t i = 0; i < names.size(); ++i) {
        list += (i == 0 ? "" : ", ") + quoted(names[i]) + " " + std::to_string(i);
    }
    return std::string("set ") + axis + "tics noenhanced scale 0 font ',10' (" + list + ")\nset " + axis + "range [" +
           (axis[0] == 'y' ? number(static_cast<double>(names.size()) - 0.5) + ":-0.5]\n"
                           : "-0.5:" + number(static_cast<double>(names.size()) - 0.5) + "]\n");
}

std::string outline(double column, double row) {
    constexpr double half = 0.46;
    return "set object rectangle from " + number(column - half) + "," + number(row - half) + " to " +
           number(column + half) + "," + number(row + half) + " front fs empty border lc rgb '#222222' lw 2\n";
}

} // namespace

Plot plot_of(HeatTable const& chart) {
    check(chart);
    Plot plot;
    plot.width = beside + cell_width * static_cast<int>(chart.columns.size());
    plot.height = around + cell_height * static_cast<int>(chart.rows.size());
    plot.data = "$cells << EOD\n";
    std::string labels;
    for (std::size_t row = 0; row < chart.rows.size(); ++row) {
        for (std::size_t column = 0; column < chart.columns.size(); ++column) {
            double const value = chart.values[row][column];
            if (!std::isfinite(value) || value <= 0) {
                continue;
            }
            plot.data += std::to_string(column) + " " + std::to_string(row) + " " + number(std::log2(value)) + "\n";
            labels += "set label " + quoted(two_digits(value)) + " at " + std::to_string(column) + "," +
                      std::to_string(row) + " center front font ',10'\n";
            if (chart.goal > 0 && value > chart.goal) {
                labels += outline(static_cast<double>(column), static_cast<double>(row));
            }
        }
    }
    plot.data += "EOD\n";
    plot.commands = common_look(chart.title) + "unset key\nunset grid\nunset border\nunset colorbox\n" +
                    axis_title("x", chart.x_title) + marks("x", chart.columns) + marks("y", chart.rows) +
                    "set palette defined (-" + number(octaves) + " '#4393c3', 0 '#ffffff', " + number(octaves) +
                    " '#d6604d')\nset cbrange [-" + number(octaves) + ":" + number(octaves) + "]\n" + labels +
                    "plot $cells using 1:2:(0.5):(0.5):3 with boxxyerror fs solid noborder fc palette\n";
    return plot;
}

} // namespace framelet::bench
