#include "tests/evaluation/report/report_charts.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "common/error.h"
#include "tests/evaluation/report/report_text.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

using Value = std::function<double(ReportRun const&)>;

double relative_error(ReportRun const& run) {
    return run.mse / std::max(run.noise, least_mse);
}

Spread spread_over(std::vector<ReportRun> const& runs, Value const& value) {
    std::vector<double> values;
    std::ranges::transform(runs, std::back_inserter(values), value);
    return spread_of(std::move(values));
}

std::vector<Mark> core_marks() {
    std::vector<Mark> marks;
    for (int const cores : {2, 8, 32}) {
        marks.push_back({cores * core_rate / screen_pixels, "1080p, " + std::to_string(cores) + " cores"});
    }
    return marks;
}

/// A curve for each method over all scenes, with a point for each value of `step`.
std::vector<Curve> curves_of(std::vector<ReportRun> const& runs, Value const& step, Value const& x, Value const& y) {
    std::vector<Curve> curves;
    for (std::string const& method : distinct(runs, &ReportRun::method)) {
        Curve curve{method, {}, {}};
        for (double const value : distinct(runs, step)) {
            auto const there =
                part(runs, [&](ReportRun const& run) { return run.method == method && step(run) == value; });
            Spread const spread = spread_over(there, y);
            curve.x.push_back(spread_over(there, x).mean);
            curve.y.push_back(spread.mean);
            curve.low.push_back(spread.low);
            curve.high.push_back(spread.high);
        }
        curves.push_back(std::move(curve));
    }
    return curves;
}

/// Chart of a value at each machine, without a link's limit.
Curves machine_chart(ReportFigures const& figures, std::string const& what, Value const& value) {
    return {.title = what + ": geometric mean over scenes, quartiles shaded",
            .x_title = "machine [samples a displayed pixel and second]",
            .y_title = what,
            .log_x = true,
            .log_y = true,
            .curves = curves_of(unlimited(figures.runs), &ReportRun::machine, &ReportRun::machine, value),
            .marks = core_marks()};
}

Curves flip_chart(ReportFigures const& figures) {
    return machine_chart(figures, "FLIP", &ReportRun::flip);
}

Curves steadiness_chart(ReportFigures const& figures) {
    return machine_chart(figures, "unsteadiness (second difference of the error)", &ReportRun::unsteadiness);
}

Curves bits_chart(ReportFigures const& figures) {
    return {.title = "error over the reference's own noise: geometric mean over scenes, quartiles shaded",
            .x_title = "sent [bits a displayed pixel and second]",
            .y_title = "error over the reference's own noise",
            .log_x = true,
            .log_y = true,
            .curves = curves_of(part(figures.runs, [](ReportRun const& run) { return run.link > 0; }), &ReportRun::link,
                                &ReportRun::bits, relative_error)};
}

Curves live_chart(std::vector<json> const& live) {
    Curves chart{.title = "the real programs: a point a scene",
                 .x_title = "pictures a second",
                 .y_title = "mean squared error over the best method's",
                 .log_y = true,
                 .points_only = true,
                 .curves = {}};
    for (json const& scene : live) {
        double least = INFINITY;
        for (json const& figures : scene["methods"]) {
            least = std::min(least, figures["mse"].get<double>());
        }
        for (auto const& [method, figures] : scene["methods"].items()) {
            auto curve = std::ranges::find(chart.curves, method, &Curve::name);
            if (curve == chart.curves.end()) {
                chart.curves.push_back({method, {}, {}});
                curve = std::prev(chart.curves.end());
            }
            curve->x.push_back(figures["pictures_per_second"]);
            curve->y.push_back(figures["mse"].get<double>() / std::max(least, least_mse));
        }
    }
    return chart;
}

template <class Chart>
void draw_png(Chart const& chart, std::filesystem::path const& stem) {
    draw(chart, stem);
    std::filesystem::remove(stem.string() + ".svg"); // the page shows the PNG
}

} // namespace

Spread spread_of(std::vector<double> values) {
    FRAMELET_CHECK(!values.empty());
    std::ranges::sort(values);
    double sum = 0;
    for (double& value : values) {
        value = std::log(std::max(value, least_mse));
        sum += value;
    }
    auto const at = [&](double share) {
        double const rank = share * static_cast<double>(values.size() - 1);
        auto const below = static_cast<std::size_t>(rank);
        double const above = values[std::min(below + 1, values.size() - 1)];
        return std::exp(values[below] + (rank - static_cast<double>(below)) * (above - values[below]));
    };
    return {at(0.25), std::exp(sum / static_cast<double>(values.size())), at(0.75)};
}

Curves speed_chart(ReportFigures const& figures) {
    return machine_chart(figures, "error over the reference's own noise", relative_error);
}

void draw_report_charts(ReportFigures const& figures, std::filesystem::path const& folder) {
    draw_png(speed_chart(figures), folder / "speed");
    draw_png(flip_chart(figures), folder / "flip");
    draw_png(steadiness_chart(figures), folder / "steadiness");
    if (Curves const bits = bits_chart(figures); !bits.curves.empty()) {
        draw_png(bits, folder / "bits");
    }
    if (!figures.live.empty()) {
        draw_png(live_chart(figures.live), folder / "live");
    }
}

} // namespace framelet::bench
