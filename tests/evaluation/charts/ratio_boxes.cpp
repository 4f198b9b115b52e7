#include "tests/evaluation/charts/ratio_boxes.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "tests/evaluation/charts/chart_style.h"

namespace framelet::bench {
namespace {

constexpr char const* suitable_color = "#0072b2";
constexpr char const* unsuitable_color = "#d55e00";
constexpr char const* published_color = "#777777";
constexpr int panel_width = 620;
constexpr int single_panel_width = 1000;
constexpr int panel_height = 350;
constexpr int header_height = 70;
constexpr double text_share = 0.18; // of a panel's height, for the two rows of per cents

/// `sorted` ascending; between neighbours linear, from a value to infinity infinite.
double percentile(std::vector<double> const& sorted, double share) {
    double const place = share * static_cast<double>(sorted.size() - 1);
    auto const below = static_cast<std::size_t>(place);
    double const weight = place - static_cast<double>(below);
    if (weight == 0 || sorted[below] == sorted[below + 1]) {
        return sorted[below];
    }
    return sorted[below] + weight * (sorted[below + 1] - sorted[below]);
}

using Summaries = std::vector<RatioSummary>;

std::vector<Summaries> summarise(RatioBoxes const& chart) {
    std::vector<Summaries> out;
    for (RatioScene const& scene : chart.scenes) {
        Summaries summaries;
        for (RatioRun const& run : scene.runs) {
            summaries.push_back(summarise_ratios(run.ratios));
        }
        if (summaries.empty()) {
            throw InputError("chart '" + chart.title + "': scene '" + scene.name + "' has no run");
        }
        out.push_back(std::move(summaries));
    }
    if (out.empty()) {
        throw InputError("chart '" + chart.title + "' has no scene");
    }
    return out;
}

Range range_of(std::vector<Summaries> const& scenes) {
    std::vector<double> values{1};
    for (Summaries const& scene : scenes) {
        for (RatioSummary const& s : scene) {
            values.insert(values.end(), {s.p5, s.p25, s.p50, s.p75, s.p95});
        }
    }
    Range range = log_range(values);
    double const margin = std::pow(range.high / range.low, 0.04);
    return {range.low / margin, range.high * margin};
}

/// A row a run: place, the five percentiles in the order of gnuplot's candlesticks, 1 where the 75th is suitable.
std::string data_block(std::size_t scene, Summaries const& runs, Range const& range) {
    std::string out = "$scene" + std::to_string(scene) + " << EOD\n";
    for (std::size_t i = 0; i < runs.size(); ++i) {
        RatioSummary const& s = runs[i];
        out += std::to_string(i);
        for (double const value : {s.p25, s.p5, s.p95, s.p75, s.p50}) {
            out += ' ';
            out += number(on_log_axis(value, range));
        }
        out += s.p75 <= 1 ? " 1\n" : " 0\n";
    }
    return out + "EOD\n";
}

std::string text(std::string const& what, std::string const& where, std::string const& more, char const* color) {
    return "set label " + quoted(what) + " noenhanced at " + where + " " + more + " textcolor rgb '" + color + "'\n";
}

/// As Table 7.2 counts: the greatest whole percentile that is suitable.
std::string per_cent(double value) {
    return number(std::floor(value));
}

std::string percent_rows(RatioScene const& scene, Summaries const& summaries) {
    char const* const measured_row = "graph 0.955";
    char const* const published_row = "graph 0.885";
    std::string out = text("here %", std::string("graph -0.012, ") + measured_row, "right font ',9'", suitable_color);
    out += text("published %", std::string("graph -0.012, ") + published_row, "right font ',9'", published_color);
    for (std::size_t i = 0; i < summaries.size(); ++i) {
        std::string const x = "first " + std::to_string(i) + ", ";
        char const* const color = summaries[i].p75 <= 1 ? suitable_color : unsuitable_color;
        out += text(per_cent(summaries[i].suitable), x + measured_row, "center font ',9'", color);
        out += text(scene.runs[i].published ? per_cent(*scene.runs[i].published) : "-", x + published_row,
                    "center font ',9'", published_color);
    }
    return out;
}

std::string run_marks(RatioScene const& scene) {
    std::string marks;
    bool rotated = false;
    for (std::size_t i = 0; i < scene.runs.size(); ++i) {
        marks += (i == 0 ? "" : ", ") + quoted(scene.runs[i].label) + " " + std::to_string(i);
        rotated = rotated || scene.runs[i].label.size() > 4;
    }
    std::string const last = number(static_cast<double>(scene.runs.size()) - 0.3);
    return "set xrange [-0.7:" + last + "]\nset xtics noenhanced " + (rotated ? "rotate by 40 right" : "norotate") +
           " scale 0 font ',9' (" + marks + ")\n";
}

std::string panel(RatioBoxes const& chart, std::size_t i, Summaries const& summaries, Range const& range) {
    RatioScene const& scene = chart.scenes[i];
    std::string const block = "$scene" + std::to_string(i);
    Range const with_text{range.low, range.high * std::pow(range.high / range.low, text_share / (1 - text_share))};
    std::string out = "set title " + quoted(scene.name) + " noenhanced font ',12' offset 0,-0.5\n";
    out += run_marks(scene) + log_axis("y", with_text, range.low, range.high) + percent_rows(scene, summaries);
    out += "plot 1 with lines lw 1.5 lc rgb '#222222' notitle";
    for (bool const suitable : {true, false}) {
        out += ", \\\n  " + block + " using ($7==" + (suitable ? "1" : "0") +
               "?$1:1/0):2:3:4:5 with candlesticks whiskerbars 0.5 lw 1.3 lc rgb '" +
               (suitable ? suitable_color : unsuitable_color) + "' notitle";
    }
    return out + ", \\\n  " + block + " using 1:6:6:6:6 with candlesticks lw 2.2 lc rgb '#000000' notitle\n";
}

/// Drawn with the first panel.
std::string header(std::string const& title, int height) {
    std::string const legend = "screen 0.5, screen " + number(1 - 46.0 / height);
    return text(title, "screen 0.5, screen " + number(1 - 20.0 / height), "center font ',15'", "#000000") +
           text("■ 75th percentile ≤ 1", legend, "right offset -1,0 font ',10'", suitable_color) +
           text("■ 75th percentile > 1", legend, "left offset 1,0 font ',10'", unsuitable_color);
}

} // namespace

RatioSummary summarise_ratios(std::span<double const> ratios) {
    if (ratios.empty()) {
        throw InputError("a run without error ratios cannot be summarised");
    }
    std::vector<double> sorted(ratios.begin(), ratios.end());
    if (std::any_of(sorted.begin(), sorted.end(), [](double ratio) { return !(ratio >= 0); })) {
        throw InputError("an error ratio is negative or not a number");
    }
    std::sort(sorted.begin(), sorted.end());
    auto const suitable = std::upper_bound(sorted.begin(), sorted.end(), 1.0) - sorted.begin();
    return {percentile(sorted, 0.05), percentile(sorted, 0.25),
            percentile(sorted, 0.5),  percentile(sorted, 0.75),
            percentile(sorted, 0.95), 100.0 * static_cast<double>(suitable) / static_cast<double>(sorted.size())};
}

Plot plot_of(RatioBoxes const& chart) {
    std::vector<Summaries> const scenes = summarise(chart);
    Range const range = range_of(scenes);
    int const count = static_cast<int>(scenes.size());
    int const columns = std::min(count, 2);
    int const rows = (count + columns - 1) / columns;
    Plot plot;
    plot.width = count == 1 ? single_panel_width : columns * panel_width;
    plot.height = rows * panel_height + header_height;
    double const top = 1 - static_cast<double>(header_height) / plot.height;

    plot.commands = common_look("") + axis_title("x", chart.x_title) + axis_title("y", chart.y_title);
    plot.commands += "set grid noxtics ytics\nset boxwidth 0.6\nset style fill solid 0.35 border\n";
    plot.commands += "set lmargin 13\nset rmargin 2\nset key off\n";
    plot.commands += "set multiplot\n" + header(chart.title, plot.height);
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        plot.data += data_block(i, scenes[i], range);
        int const column = static_cast<int>(i) % columns;
        int const row = static_cast<int>(i) / columns;
        plot.commands += "set size " + number(1.0 / columns) + "," + number(top / rows) + "\nset origin " +
                         number(static_cast<double>(column) / columns) + "," + number(top * (rows - 1 - row) / rows) +
                         "\n";
        plot.commands += panel(chart, i, scenes[i], range) + "unset label\n";
    }
    plot.commands += "unset multiplot\n";
    return plot;
}

} // namespace framelet::bench
