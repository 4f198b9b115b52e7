#include "tests/evaluation/verbs.h"

#include <array>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "common/picture_writer.h"
#include "tests/evaluation/charts/charts.h"
#include "tests/evaluation/charts/side_by_side.h"
#include "tests/evaluation/comparison.h"
#include "tests/evaluation/link_trials.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

void draw_comparison(Comparison const& comparison, std::filesystem::path const& folder) {
    std::filesystem::create_directories(folder);
    ErrorOverTime chart{.title = comparison.scene + ": error over time", .series = {}};
    std::vector<Labelled> shown;
    for (MethodRecord const& record : comparison.records) {
        ErrorSeries series{record.method, {}, {}, record.run.displayed};
        for (std::size_t i = 0; i < record.measures.size(); ++i) {
            series.seconds.push_back(reference_time(comparison.parameters, i));
            series.mse.push_back(record.measures[i].mse);
        }
        chart.series.push_back(std::move(series));
        shown.push_back({record.method, record.sample});
    }
    draw(chart, folder / (comparison.scene + "-error"));
    write_png(folder / (comparison.scene + "-side-by-side.png"), side_by_side(comparison.reference_sample, shown));
}

/// One curve a method: a point for each of the runs.
using Cost = double (*)(Comparison const&, MethodRecord const&);

ParetoCurves pareto_chart(std::vector<Comparison> const& runs, std::string title, std::string x_title,
                          std::vector<std::string> const& labels, Cost cost) {
    ParetoCurves chart{.title = std::move(title), .x_title = std::move(x_title), .curves = {}};
    for (std::size_t m = 0; m < runs.front().records.size(); ++m) {
        ParetoCurve curve{runs.front().records[m].method, {}};
        for (std::size_t i = 0; i < runs.size(); ++i) {
            curve.points.push_back({cost(runs[i], runs[i].records[m]), mean_mse(runs[i].records[m]), labels[i]});
        }
        chart.curves.push_back(std::move(curve));
    }
    return chart;
}

json points_of(ParetoCurves const& chart) {
    json result = json::object();
    for (ParetoCurve const& curve : chart.curves) {
        for (ParetoPoint const& point : curve.points) {
            result[curve.method].push_back({{"cost", point.cost}, {"mse", point.error}, {"at", point.label}});
        }
    }
    return result;
}

void print_chart(ParetoCurves const& chart) {
    std::printf("\n%s: mean squared error (%s)\n", chart.title.c_str(), chart.x_title.c_str());
    for (ParetoCurve const& curve : chart.curves) {
        std::printf("  %-12s", curve.method.c_str());
        for (ParetoPoint const& point : curve.points) {
            std::printf("  %9.3e (%.3g)", point.error, point.cost);
        }
        std::printf("\n");
    }
}

/// Runs all methods once for each value that `set` puts into the parameters.
template <class Set>
std::vector<Comparison> sweep(BenchScene& scene, StudyOptions const& options, std::size_t count, Set&& set) {
    Reference const reference = reference_of(scene, options);
    std::vector<Comparison> runs;
    for (std::size_t i = 0; i < count; ++i) {
        RunParameters parameters = options.run;
        set(parameters, i);
        runs.push_back(compare_methods(scene, reference, options.methods, parameters, options.costs));
    }
    return runs;
}

json finish(ParetoCurves const& chart, StudyOptions const& options, std::string const& file) {
    print_chart(chart);
    if (!options.charts.empty()) {
        std::filesystem::create_directories(options.charts);
        draw(chart, options.charts / file);
    }
    return points_of(chart);
}

constexpr std::array speeds{2.0, 5.0, 10.0, 30.0};
constexpr std::array megabits{1.0, 5.0, 20.0, 100.0};
constexpr std::array delays{0.0, 0.015, 0.05, 0.1}; ///< one way, seconds

std::vector<std::string> labels_of(auto const& values, char const* unit, double scale = 1) {
    std::vector<std::string> labels;
    for (double const value : values) {
        char text[40];
        std::snprintf(text, sizeof(text), "%g %s", value * scale, unit);
        labels.emplace_back(text);
    }
    return labels;
}

double delay_ms(Comparison const&, MethodRecord const& record) {
    return 1e3 * record.run.mean_delay;
}

double bytes_a_second(Comparison const& comparison, MethodRecord const& record) {
    return static_cast<double>(record.run.bytes) / comparison.parameters.seconds;
}

json rate_sweep(BenchScene& scene, StudyOptions const& options) {
    auto const runs = sweep(scene, options, megabits.size(),
                            [](RunParameters& p, std::size_t i) { p.link.bits_per_second = 1e6 * megabits[i]; });
    return finish(pareto_chart(runs, scene.name + ": error against bytes", "sent [bytes/s]",
                               labels_of(megabits, "Mbit/s"), bytes_a_second),
                  options, scene.name + "-bytes");
}

json delay_sweep(BenchScene& scene, StudyOptions const& options) {
    auto const runs =
        sweep(scene, options, delays.size(), [](RunParameters& p, std::size_t i) { p.link.delay_seconds = delays[i]; });
    return finish(pareto_chart(runs, scene.name + ": error against delay", "from step to picture [ms]",
                               labels_of(delays, "ms each way", 1e3), delay_ms),
                  options, scene.name + "-delay");
}

} // namespace

json compare(BenchScene& scene, StudyOptions const& options) {
    Reference const reference = reference_of(scene, options);
    Comparison const comparison = compare_methods(scene, reference, options.methods, options.run, options.costs);
    print(comparison);
    if (!options.charts.empty()) {
        draw_comparison(comparison, options.charts);
    }
    return to_json(comparison);
}

json pareto(BenchScene& scene, StudyOptions const& options) {
    auto const runs =
        sweep(scene, options, speeds.size(), [](RunParameters& p, std::size_t i) { p.frames_per_second = speeds[i]; });
    json result;
    // Work, not time: what the same run would have taken of the calibrated machine.
    result["cpu"] = finish(pareto_chart(runs, scene.name + ": error against server CPU",
                                        "server CPU, calibrated machine [s/s]", labels_of(speeds, "frames/s"),
                                        [](Comparison const& c, MethodRecord const& r) {
                                            return r.run.cpu.server() / c.machine / c.parameters.seconds;
                                        }),
                           options, scene.name + "-cpu");
    result["bytes"] = rate_sweep(scene, options);
    result["delay"] = delay_sweep(scene, options);
    return result;
}

json link_study(BenchScene& scene, StudyOptions const& options) {
    json result;
    result["rate"] = rate_sweep(scene, options);
    result["delay"] = delay_sweep(scene, options);
    result["trials"] = link_trials(scene, reference_of(scene, options), options);
    return result;
}

json prepare_reference(BenchScene& scene, StudyOptions const& options) {
    Reference const reference = reference_of(scene, options);
    std::printf("%zu pictures in %s\n", reference.size(), reference.folder().c_str());
    return {{"pictures", reference.size()}, {"folder", reference.folder().string()}};
}

} // namespace framelet::bench
