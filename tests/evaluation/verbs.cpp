#include "tests/evaluation/verbs.h"

#include <cstdio>

#include <nlohmann/json.hpp>

#include "common/error.h"
#include "common/picture_writer.h"
#include "tests/evaluation/ablation.h"
#include "tests/evaluation/calibrate.h"
#include "tests/evaluation/charts/charts.h"
#include "tests/evaluation/charts/picture_sheet.h"
#include "tests/evaluation/comparison.h"
#include "tests/evaluation/limits.h"
#include "tests/evaluation/report/report_page.h"
#include "tests/evaluation/sensitivity.h"
#include "tests/evaluation/stillness.h"
#include "tests/evaluation/table.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

void draw_comparison(Comparison const& comparison, std::filesystem::path const& folder) {
    std::filesystem::create_directories(folder);
    ErrorOverTime chart{.title = comparison.scene + ": error over time", .series = {}};
    std::vector<Picture> shown;
    for (MethodRecord const& record : comparison.records) {
        chart.series.push_back(error_series(record, comparison.parameters));
        shown.push_back(record.sample);
    }
    draw(chart, folder / (comparison.scene + "-error"));
    write_png(folder / (comparison.scene + "-side-by-side.png"), beside_reference(comparison.reference_sample, shown));
}

json answer_compare(VerbOptions& options) {
    StudyOptions& study = options.study;
    study.sees_events = !options.start;
    json result = json::array();
    for (auto const& file : study.scenes) {
        Subject const subject = prepare(file, study);
        Comparison const comparison =
            compare_methods(*subject.scene, subject.reference, study.methods.empty() ? method_names() : study.methods,
                            subject.run, study.costs);
        print(comparison);
        if (!study.charts.empty()) {
            draw_comparison(comparison, study.charts);
        }
        result.push_back(to_json(comparison));
    }
    return result;
}

json answer_table(VerbOptions& options) {
    if (options.study.methods.empty()) {
        options.study.methods = {"afr", "framelet-unwarped", "framelet"};
    }
    auto const published = read_published_table(source_folder / "tests/evaluation/published_table_7_2.csv");
    std::vector<std::string> names;
    for (auto const& file : options.study.scenes) {
        names.push_back(file.stem().string());
    }
    auto part = part_of(published, options.table_runs, options.scenes.empty() ? std::vector<std::string>{} : names);
    if (options.quick) {
        std::erase_if(part.runs, [](PublishedRun const& run) { return run.side > 256; });
    }
    if (part.runs.empty()) {
        throw InputError("--quick leaves none of these runs: it takes those of 256x256 pixels alone");
    }
    return run_table(part, source_folder / "scenes", options.study);
}

json answer_ablation(VerbOptions& options) {
    options.study.sees_events = !options.start;
    return measure_ablation({}, options.study);
}

json answer_stillness(VerbOptions& options) {
    return measure_stillness({}, options.study);
}

json answer_sensitivity(VerbOptions& options) {
    options.study.sees_events = !options.start;
    json result = json::array();
    for (auto const& file : options.study.scenes) {
        result.push_back(sensitivity(prepare(file, options.study), options.study));
    }
    return result;
}

json answer_estimators(VerbOptions& options) {
    EstimatorStudy& study = options.estimators;
    study.scenes = options.study.scenes;
    study.observation.seed = static_cast<std::uint32_t>(options.study.run.seed);
    study.charts = options.study.charts;
    study.quick = options.quick;
    return compare_estimators(study);
}

json answer_correspondence(VerbOptions& options) {
    CorrespondenceStudy& study = options.correspondence;
    study.scenes = options.study.scenes;
    study.camera = options.study.camera;
    study.viewport = options.study.run.viewport;
    study.times = options.quick ? 1 : study.times;
    return measure_correspondence(study);
}

json answer_calibrate(VerbOptions& options) {
    auto const scene = load_bench_scene(options.study.scenes.front(), options.study.camera);
    json const costs = to_json(calibrate(*scene, options.study.run.viewport, options.quick ? 3 : 15));
    for (auto const& [name, cost] : costs.items()) {
        std::printf("%-26s %8.2f ns\n", name.c_str(), cost.get<double>());
    }
    return costs;
}

json answer_limits(VerbOptions& options) {
    auto const scene = load_bench_scene(options.study.scenes.front(), options.study.camera);
    return measure_limits(*scene, options.study.run.viewport, options.quick ? 3 : 9);
}

template <class List>
void fall_back(List& chosen, List usual) {
    chosen = chosen.empty() ? std::move(usual) : chosen;
}

/// Methods, machines and links of the report's runs on the virtual clock, where it is not told.
void choose_runs(VerbOptions& options) {
    ReportOptions& report = options.report;
    StudyOptions& study = options.study;
    if (options.quick) {
        fall_back(study.methods, {"framed+h264", "framed+warp", "tsar", "framelet-unwarped", "framelet"});
        fall_back(report.machines, {2, 10});
        fall_back(report.links, {5, 20});
    }
    fall_back(study.methods, {"framed+h264", "framed+warp", "interruptible", "tsar", "afr", "framelet-unwarped",
                              "framelet", "oracle"});
    fall_back(report.machines, {0.5, 1, 2, 5, 10, 20, 60});
    fall_back(report.links, {0.5, 2, 5, 20, 80});
    if (options.without_links) {
        report.links.clear();
    }
    std::ranges::copy_if(study.methods, std::back_inserter(report.linked_methods), [](std::string const& method) {
        return method != "oracle" && method != "tsar" && method != "afr"; // they know no link
    });
}

/// What it runs of real programs, and what pictures it takes.
void choose_programs(VerbOptions& options) {
    ReportOptions& report = options.report;
    report.live.methods = {"framelet", "framelet-unwarped", "framed+h264", "framed+warp"};
    report.live.samples_per_side = 2;
    report.live.moments = 2;
    report.quick = options.quick;
    if (options.quick) {
        report.feature_viewport = {320, 180};
        report.live.viewport = {320, 180};
        report.live.seconds = 2;
        report.live.moments = 1;
        fall_back(options.live_scenes, {"vehicle_chase"});
    }
    fall_back(options.live_scenes, {"vehicle_chase", "globe", "stop", "foliage"});
    if (!options.without_live) {
        std::ranges::transform(options.live_scenes, std::back_inserter(report.live_scenes), scene_file);
    }
    for (char const* const name : {"stop", "globe", "vehicle_chase"}) {
        report.pictured_scenes.push_back(scene_file(name));
    }
}

json answer_report(VerbOptions& options) {
    choose_runs(options);
    choose_programs(options);
    ReportFigures const figures = measure_report(options.report, options.study);
    write_report(figures, options.report, options.study, options.command);
    return {{"runs", figures.runs.size()}, {"commit", figures.commit}};
}

std::vector<std::string> const vehicles{"vehicle_approach", "vehicle_chase", "vehicle_crossing", "vehicle_fixed",
                                        "vehicle_flyby"};
std::vector<std::string> const chase{"vehicle_chase"};
constexpr Scale screen{.viewport = {1280, 720}};
constexpr Scale half_screen{.viewport = {640, 360}};

} // namespace

std::span<Verb const> verbs() {
    static Verb const all[] = {
        {.name = "compare",
         .question = "Error over time and cost of every method, beside the reference",
         .answer = answer_compare,
         .scenes = chase,
         .add_options = add_compare_options},
        {.name = "report",
         .question = "All of docs/RESULTS.md: speed against accuracy, scene by scene, the real programs (hours)",
         .answer = answer_report,
         .scenes = {},
         .usual = {.rate = 30},
         .quick = {.viewport = {128, 72}, .seconds = 1, .rate = 15},
         .add_options = add_report_options},
        {.name = "table",
         .question = "Runs and scenes of the dissertation's Table 7.2 (--quick: those of 256x256)",
         .answer = answer_table,
         .scenes = vehicles,
         .usual = {.seconds = 5, .rate = 10},
         .quick = {.seconds = 5, .rate = 10},
         .add_options = add_table_options},
        {.name = "ablation",
         .question = "What each part of framelet buys, and what it costs: error, bytes and work without it",
         .answer = answer_ablation,
         .scenes = {"vehicle_chase", "vehicle_flyby", "vehicle_fixed", "stop", "windmill", "globe", "dim"}},
        {.name = "stillness",
         .question = "How good the picture gets once everything stands still, how soon, and what is sent then",
         .answer = answer_stillness,
         .scenes = {},
         .usual = {.seconds = 4, .rate = 20},
         .quick = {.viewport = {128, 72}, .rate = 20}},
        {.name = "sensitivity",
         .question = "How tsar answers to steeper and flatter templates of its error estimate",
         .answer = answer_sensitivity,
         .scenes = chase},
        {.name = "estimators",
         .question = "Cost of error estimators against their agreement with the ideal density",
         .answer = answer_estimators,
         .scenes = {"vehicle_crossing", "windmill", "vehicle_fixed", "vehicle_chase", "vehicle_flyby",
                    "vehicle_approach", "globe", "flicker", "foliage", "stop"},
         .add_options = [](CLI::App& verb, VerbOptions& o) { add_estimator_options(verb, o.estimators); }},
        {.name = "correspondence",
         .question = "How far off the viewer shows what it moves",
         .answer = answer_correspondence,
         .scenes = {"globe", "windmill", "vehicle_approach", "vehicle_chase", "vehicle_crossing", "vehicle_fixed",
                    "vehicle_flyby"},
         .usual = screen,
         .quick = half_screen,
         .add_options = add_correspondence_options},
        {.name = "calibrate",
         .question = "What every stage costs on this machine",
         .answer = answer_calibrate,
         .scenes = chase,
         .usual = {.viewport = {512, 512}},
         .quick = {.viewport = {512, 512}}},
        {.name = "limits",
         .question = "The whole server against bare Embree and shading",
         .answer = answer_limits,
         .scenes = chase,
         .usual = screen,
         .quick = half_screen},
    };
    return all;
}

} // namespace framelet::bench
