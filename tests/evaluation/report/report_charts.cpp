#include "tests/evaluation/report/report_charts.h"

#include <algorithm>

#include "tests/evaluation/measures/measures.h"
#include "tests/evaluation/report/report_tables.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

template <class Chart>
void draw_png(Chart const& chart, std::filesystem::path const& stem) {
    draw(chart, stem);
    std::filesystem::remove(stem.string() + ".svg"); // the page shows the PNG
}

Curve& curve_of(Curves& chart, std::string const& method) {
    auto const found = std::ranges::find(chart.curves, method, &Curve::name);
    return found != chart.curves.end() ? *found : chart.curves.emplace_back(Curve{method, {}, {}});
}

/// One panel: PSNR of each method in one scene over a part of a link, where `belongs` says so; points in order.
template <class Belongs>
Curves link_panel(std::vector<LinkRun> links, std::string const& scene, std::string const& axis, double LinkCase::*part,
                  Belongs&& belongs) {
    std::ranges::sort(links, {}, [part](LinkRun const& run) { return run.link.*part; });
    Curves chart{.title = scene, .x_title = axis, .y_title = "PSNR, dB", .curves = {}};
    for (LinkRun const& run : links) {
        if (run.figures["scene"] != scene || !belongs(run.link)) {
            continue;
        }
        for (auto const& [method, figures] : run.figures["methods"].items()) {
            Curve& curve = curve_of(chart, method);
            curve.x.push_back(run.link.*part);
            curve.y.push_back(figures["psnr"]);
        }
    }
    return chart;
}

} // namespace

Arrows live_chart(std::vector<json> const& live) {
    Arrows chart{.title = "the real programs: from the best rival to framelet",
                 .x_title = "pictures a second",
                 .y_title = "PSNR, dB",
                 .arrows = {}};
    for (json const& scene : live) {
        std::string const name = best_rival(scene, "mse", 1).second;
        if (name.empty()) {
            continue;
        }
        json const& own = scene["methods"]["framelet"];
        json const& rival = scene["methods"][name];
        chart.arrows.push_back(
            {scene["scene"], {rival["pictures_per_second"], rival["psnr"]}, {own["pictures_per_second"], own["psnr"]}});
    }
    return chart;
}

Panels links_chart(std::vector<LinkRun> const& links, ReportOptions const& options) {
    std::vector<std::string> scenes;
    for (LinkRun const& run : links) {
        if (std::string const scene = run.figures["scene"]; std::ranges::find(scenes, scene) == scenes.end()) {
            scenes.push_back(scene);
        }
    }
    Panels chart{.columns = static_cast<int>(scenes.size()), .panels = {}};
    LinkCase const& usual = options.usual;
    for (std::string const& scene : scenes) {
        chart.panels.push_back(link_panel(links, scene, "Mbit/s", &LinkCase::megabits,
                                          [&](LinkCase const& link) { return link.round_trip == usual.round_trip; }));
        chart.panels.back().log_x = true;
    }
    for (std::string const& scene : scenes) {
        chart.panels.push_back(link_panel(links, scene, "round trip, ms", &LinkCase::round_trip,
                                          [&](LinkCase const& link) { return link.megabits == usual.megabits; }));
    }
    return chart;
}

Curves cores_chart(std::vector<CoreRun> const& runs) {
    Curves chart{.title = "virtual clock: error over processors",
                 .x_title = "cores that render 1920x1080",
                 .y_title = "PSNR of the geometric mean over scenes, dB",
                 .log_x = true,
                 .curves = {}};
    for (CoreRun const& run : runs) {
        Curve& curve = curve_of(chart, run.method);
        if (std::ranges::find(curve.x, run.cores) == curve.x.end()) {
            curve.x.push_back(run.cores);
            curve.y.push_back(psnr_from_mse(mean_error(runs, run.method, run.cores)));
        }
    }
    return chart;
}

void draw_report_charts(ReportFigures const& figures, ReportOptions const& options) {
    std::filesystem::path const folder = options.documents / "pictures";
    if (!figures.live.empty()) {
        draw_png(live_chart(figures.live), folder / "live");
    }
    if (!figures.links.empty()) {
        draw_png(links_chart(figures.links, options), folder / "links");
    }
    if (!figures.cores.empty()) {
        draw_png(cores_chart(figures.cores), folder / "cores");
    }
}

} // namespace framelet::bench
