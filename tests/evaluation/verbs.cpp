#include "tests/evaluation/verbs.h"

#include <cstdio>
#include <set>

#include <nlohmann/json.hpp>

#include "common/error.h"
#include "tests/evaluation/ablation.h"
#include "tests/evaluation/calibrate.h"
#include "tests/evaluation/charts/charts.h"
#include "tests/evaluation/charts/picture_sheet.h"
#include "tests/evaluation/comparison.h"
#include "tests/evaluation/correspondence/correspondence.h"
#include "tests/evaluation/gate.h"
#include "tests/evaluation/limits.h"
#include "tests/evaluation/pauses.h"
#include "tests/evaluation/processors.h"
#include "tests/evaluation/report/report_page.h"
#include "tests/evaluation/stability.h"
#include "tests/evaluation/stillness.h"
#include "tests/evaluation/table.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

void draw_comparison(Comparison const& comparison, std::filesystem::path const& folder) {
    ErrorOverTime chart{.title = comparison.scene + ": error over time", .series = {}};
    std::vector<Picture> shown;
    for (MethodRecord const& record : comparison.records) {
        chart.series.push_back(error_series(record, comparison.parameters));
        shown.push_back(record.sample);
    }
    draw(chart, folder / (comparison.scene + "-error"));
    write_beside_reference(folder / (comparison.scene + "-side-by-side.png"), comparison.reference_sample, shown);
}

/// Charts each method's error over the time of a round trip.
void draw_round_trips(std::vector<Comparison> const& comparisons, std::filesystem::path const& folder) {
    Curves chart{.title = comparisons.front().scene + ": error over the round trip",
                 .x_title = "round trip, ms",
                 .y_title = "mean squared error",
                 .log_y = true,
                 .curves = {}};
    for (Comparison const& comparison : comparisons) {
        chart.curves.resize(comparison.records.size());
        for (std::size_t i = 0; i < comparison.records.size(); ++i) {
            chart.curves[i].name = comparison.records[i].method;
            chart.curves[i].x.push_back(2e3 * comparison.parameters.link.delay_seconds);
            chart.curves[i].y.push_back(mean_mse(comparison.records[i]));
        }
    }
    draw(chart, folder / (comparisons.front().scene + "-round-trip"));
}

json answer_compare(VerbOptions& options) {
    StudyOptions const& study = options.study;
    std::vector<std::string> const& methods = study.methods.empty() ? method_names() : study.methods;
    json result = json::array();
    for (auto const& file : study.scenes) {
        Subject const subject = prepare(file, study);
        std::vector<RunParameters> runs(std::max<std::size_t>(1, options.round_trips.size()), subject.run);
        for (std::size_t i = 0; i < options.round_trips.size(); ++i) {
            runs[i].link.delay_seconds = 0.5e-3 * options.round_trips[i];
        }
        std::vector<Comparison> comparisons;
        for (RunParameters const& run : runs) {
            comparisons.push_back(compare_methods(*subject.scene, subject.reference, methods, run, study.costs));
            print(comparisons.back());
            result.push_back(to_json(comparisons.back()));
        }
        if (!study.charts.empty()) {
            draw_comparison(comparisons.back(), study.charts);
            if (comparisons.size() > 1) {
                draw_round_trips(comparisons, study.charts);
            }
        }
    }
    return result;
}

json answer_table(VerbOptions& options) {
    if (options.study.methods.empty()) {
        options.study.methods = {"afr", "framelet-unwarped", "framelet"};
    }
    PublishedTable table = published_table();
    std::erase_if(table.runs, [&](PublishedRun const& run) {
        std::vector<int> const& told = options.table_runs;
        return (options.quick && run.side > 256) ||
               (!told.empty() && std::ranges::find(told, run.number) == told.end());
    });
    if (table.runs.empty()) {
        throw InputError("--quick leaves none of these runs: it takes those of 256x256 pixels alone");
    }
    return run_table(table, options.study);
}

json answer_calibrate(VerbOptions& options) {
    auto const scene = load_bench_scene(options.study.scenes.front());
    json const costs = to_json(calibrate(*scene, options.study.run.viewport, options.quick ? 3 : 15));
    for (auto const& [name, cost] : costs.items()) {
        std::printf("%-26s %8.2f ns\n", name.c_str(), cost.get<double>());
    }
    return costs;
}

json answer_limits(VerbOptions& options) {
    auto const scene = load_bench_scene(options.study.scenes.front());
    StudyOptions const& study = options.study;
    if (!options.threads.empty()) {
        if (std::set(options.threads.begin(), options.threads.end()).size() < 2) {
            throw InputError("--threads wants two different numbers at least");
        }
        return measure_processors(*scene, study.run, study.costs, options.threads, study.charts);
    }
    return measure_limits(*scene, study.run.viewport, options.quick ? 3 : 9);
}

/// Chooses what the report runs, where it is not told.
void choose_runs(VerbOptions& options) {
    ReportOptions& report = options.report;
    std::vector<std::string>& methods = options.study.methods;
    if (methods.empty()) {
        methods = {"framed+h264", "framed+warp", "tsar", "afr", "framelet"};
    }
    report.quick = options.quick;
    report.live.methods = {"framelet", "framed+h264", "framed+warp"};
    report.live.samples_per_side = 2;
    report.live.seconds = 3;
    report.live.runs = 3;
    report.live.moments = 3;
    report.live.steadiness = false;
    constexpr std::ptrdiff_t with_cores = 6; // scenes, the first ones
    auto const& scenes = options.study.scenes;
    report.core_scenes = {scenes.begin(), scenes.begin() + std::min(std::ssize(scenes), with_cores)};
    if (options.quick) {
        report.cores = {2, 8};
        report.rates = {20};
        report.round_trips = {200};
        report.live.viewport = {320, 180};
        report.live.seconds = 2;
        report.live.moments = 1;
    }
    if (options.without_live) {
        return;
    }
    auto const live_scenes = options.quick ? std::vector{scene_file("vehicle_chase")} : options.study.scenes;
    for (std::filesystem::path const& scene : live_scenes) {
        report.flights.push_back({scene, {}});
    }
    report.linked_scenes = live_scenes;
    if (options.quick) {
        return;
    }
    report.linked_scenes = {scene_file("vehicle_chase"), scene_file("walker"), scene_file("windmill")};
    for (std::filesystem::path const& camera : files_in(source_folder / "tests/evaluation/flights", ".json")) {
        std::string const model = camera.stem().string();
        auto const asset = options.assets / model / (model + ".glb");
        if (!options.assets.empty() && std::filesystem::exists(asset)) {
            report.flights.push_back({asset, camera});
        }
    }
    report.lit_flights = {{scene_file("interior"), {}}, {scene_file("dusk"), {}}};
    std::ranges::copy_if(report.flights, std::back_inserter(report.lit_flights),
                         [](Flight const& flight) { return !flight.camera.empty(); });
}

json answer_pauses(VerbOptions& options) {
    StudyOptions const& study = options.study;
    PauseOptions pauses;
    pauses.viewport = study.run.viewport;
    pauses.seed = study.run.seed;
    pauses.rate = study.run.frames_per_second;
    return measure_pauses(study.scenes, options.quick ? 12 : 100, pauses, study.charts);
}

json answer_reference(VerbOptions& options) {
    StudyOptions const& study = options.study;
    options.reference_picture.paths.seed = static_cast<std::uint32_t>(study.run.seed);
    return write_reference_picture(study.scenes.front(), study.run.viewport, study.run.start,
                                   options.reference_picture);
}

json answer_report(VerbOptions& options) {
    choose_runs(options);
    ReportFigures const figures = measure_report(options.report, options.study);
    write_report(figures, options.report, options.study, options.command);
    return {{"runs", figures.live.size() + figures.links.size() + figures.cores.size()}, {"commit", figures.commit}};
}

std::vector<std::string> const vehicles{"vehicle_approach", "vehicle_chase", "vehicle_crossing", "vehicle_fixed",
                                        "vehicle_flyby"};
std::vector<std::string> const chase{"vehicle_chase"};
/// What moves whole, what a skin moves, what morphs, shadows that turn.
std::vector<std::string> const kinds_of_motion{"vehicle_chase", "walker", "flag", "fan"};
constexpr Scale screen{.viewport = {1280, 720}};
constexpr Scale half_screen{.viewport = {640, 360}};

} // namespace

std::span<Verb const> verbs() {
    static Verb const all[] = {
        {.name = "compare",
         .question = "Error over time and cost of every method, beside the reference",
         .answer = answer_compare,
         .scenes = kinds_of_motion,
         .add_options = add_compare_options},
        {.name = "gate",
         .question = "Whether framelet errs more than the committed figures say (exit code 1: it does)",
         .answer = [](VerbOptions& o) { return measure_gate(o.study, o.gate_file, o.write_gate); },
         .scenes = {"vehicle_chase", "walker", "dim"},
         .usual = {.viewport = {160, 96}, .seconds = 1, .rate = 20},
         .quick = {.viewport = {160, 96}, .seconds = 1, .rate = 20},
         .add_options = add_gate_options},
        {.name = "report",
         .question = "All of docs/RESULTS.md, within an hour: the real programs, links, more processors",
         .answer = answer_report,
         .scenes = {"vehicle_chase", "vehicle_flyby", "windmill", "foliage", "globe", "dim", "vehicle_fixed", "flicker",
                    "stop", "teleport", "vehicle_approach", "vehicle_crossing"},
         .usual = {.viewport = {256, 144}, .seconds = 1.6, .rate = 20},
         .quick = {.viewport = {128, 72}, .seconds = 1, .rate = 15},
         .add_options = add_report_options},
        {.name = "table",
         .question = "Runs and scenes of the dissertation's Table 7.2 (--quick: those of 256x256)",
         .answer = answer_table,
         .scenes = vehicles,
         .usual = {.seconds = 5, .rate = 10},
         .quick = {.seconds = 5, .rate = 10},
         .add_options = add_table_options},
        {.name = "stability",
         .question = "How soon the error settles after events, and whether the budget of samples is kept",
         .answer =
             [](VerbOptions& o) {
                 return measure_stability(o.study, {8, 32, 128, 1024});
             },
         .scenes = {"stop", "flicker", "teleport"},
         .usual = {.rate = 40},
         .quick = {.viewport = {128, 72}, .rate = 20}},
        {.name = "ablation",
         .question = "What each part of framelet buys, and what it costs: error, bytes and work without it",
         .answer = [](VerbOptions& o) { return measure_ablation(o.study, o.without); },
         .scenes = {"vehicle_chase", "vehicle_flyby", "vehicle_fixed", "stop", "windmill", "globe", "dim"},
         .add_options = add_ablation_options},
        {.name = "stillness",
         .question = "How good the picture gets once everything stands still, how soon, and what is sent then",
         .answer = [](VerbOptions& o) { return measure_stillness(o.study); },
         .scenes = {},
         .usual = {.seconds = 4, .rate = 20},
         .quick = {.viewport = {128, 72}, .rate = 20}},
        {.name = "pauses",
         .question = "Whether what a viewer shows at rest is what one who comes only then is shown (exit code 1: not)",
         .answer = answer_pauses,
         .scenes = {"vehicle_chase", "teleport", "windmill", "walker", "flicker", "fan"},
         .usual = {.viewport = {160, 90}},
         .quick = {.viewport = {96, 54}}},
        {.name = "correspondence",
         .question = "How far off the viewer shows what it moves",
         .answer = [](VerbOptions& o) { return measure_correspondence(o.study, o.quick ? 1 : 3); },
         .scenes = {"globe", "windmill", "vehicle_approach", "vehicle_chase", "vehicle_crossing", "vehicle_fixed",
                    "vehicle_flyby"},
         .usual = screen,
         .quick = half_screen},
        {.name = "reference",
         .question = "What a scene looks like by paths of light: one picture",
         .answer = answer_reference,
         .scenes = chase,
         .add_options = add_reference_picture_options},
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
         .quick = half_screen,
         .add_options = add_limits_options},
    };
    return all;
}

} // namespace framelet::bench
