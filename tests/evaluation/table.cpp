#include "tests/evaluation/table.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <optional>

#include <nlohmann/json.hpp>

#include "common/error.h"
#include "tests/evaluation/comparison.h"
#include "tests/evaluation/figure_table.h"
#include "tests/evaluation/measures/ratio_summary.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

json halves_of(StageSeconds const& cpu) {
    return {{"server", cpu.server()}, {"viewer", cpu.viewer()}};
}

/// Makes all runs of one scene, one picture size after the other, since the runs of one size share reference and
/// `framed`. A method without batches does the same in all of them and is run once.
json run_scene(PublishedTable const& table, BenchScene& scene, StudyOptions options, FigureTable const& progress) {
    auto const column = static_cast<std::size_t>(std::ranges::find(table.scenes, scene.name) - table.scenes.begin());
    if (column == table.scenes.size()) {
        throw InputError("the published table has no scene '" + scene.name + "'");
    }
    json cells = json::array();
    std::map<int, std::vector<PublishedRun>> runs_by_side;
    for (PublishedRun const& run : table.runs) {
        runs_by_side[run.side].push_back(run);
    }
    RivalParts const rivals = options.run.rivals;
    for (auto const& [side, runs] : runs_by_side) {
        options.run.viewport = {side, side};
        options.run.counting = Counting::total;
        Reference const reference = reference_of(scene, options);
        double const machine = machine_factor(scene, options.run, options.costs);
        auto const record = [&](std::string const& method, int batch) {
            options.run.batch_framelets = static_cast<std::size_t>(batch);
            // All methods are divided by plain whole frames, as in [Stephens 2011].
            options.run.rivals = method == "framed" ? plain_rivals : rivals;
            return record_method(scene, reference, method, options.run, machine, options.costs);
        };
        MethodRecord const framed = record("framed", 0);
        for (std::string const& method : options.methods) {
            std::optional<MethodRecord> recorded;
            for (PublishedRun const& run : runs) {
                if (!recorded || has_batches(method)) {
                    recorded = record(method, run.batch);
                }
                std::vector<double> const ratios = error_ratios(*recorded, framed);
                RatioSummary const summary = summarise_ratios(ratios);
                cells.push_back({{"method", method},
                                 {"scene", scene.name},
                                 {"run", run.number},
                                 {"batch", run.batch},
                                 {"side", run.side},
                                 {"published_percentile", run.suitable[column]},
                                 {"suitable_percentile", summary.suitable},
                                 {"median_ratio", summary.median},
                                 {"cpu_seconds", halves_of(recorded->run.cpu)},
                                 {"framed_cpu_seconds", halves_of(framed.run.cpu)},
                                 {"ratios", ratios}});
                progress.print(cells.back());
            }
        }
    }
    return cells;
}

/// Prints a table set as Table 7.2 is: a row for each run, in each scene ours beside the published percentile.
void print_table(PublishedTable const& table, json const& cells, std::string const& method) {
    std::printf("\n%s: suitable percentile (published)\n%3s %5s %5s", method.c_str(), "run", "batch", "side");
    for (std::string const& scene : table.scenes) {
        std::printf(" %17s", scene.c_str());
    }
    double ours = 0, theirs = 0, count = 0;
    for (PublishedRun const& run : table.runs) {
        std::printf("\n%3d %5d %5d", run.number, run.batch, run.side);
        for (std::string const& scene : table.scenes) {
            auto const cell = std::ranges::find_if(cells, [&](json const& c) {
                return c["method"] == method && c["scene"] == scene && c["run"] == run.number;
            });
            if (cell == cells.end()) {
                std::printf(" %17s", "-");
                continue;
            }
            double const suitable = (*cell)["suitable_percentile"], published = (*cell)["published_percentile"];
            std::printf(" %11.0f (%3.0f)", suitable, published);
            ours += suitable;
            theirs += published;
            count += 1;
        }
    }
    std::printf("\nmean %.0f (%.0f)\n", ours / count, theirs / count);
}

} // namespace

PublishedTable const& published_table() {
    // clang-format off
    static PublishedTable const table{
        {"vehicle_fixed", "vehicle_chase", "vehicle_flyby", "vehicle_approach", "vehicle_crossing"},
        {
         {0, 32, 256, {16, 100, 100, 20, 11}},
         {1, 32, 512, {11, 99, 100, 10, 16}},
         {2, 32, 1024, {6, 86, 100, 8, 6}},
         {3, 64, 256, {53, 100, 100, 53, 90}},
         {4, 64, 512, {38, 100, 100, 21, 87}},
         {5, 64, 1024, {32, 95, 100, 15, 84}},
         {6, 128, 256, {70, 100, 100, 55, 91}},
         {7, 128, 512, {57, 100, 100, 31, 91}},
         {8, 128, 1024, {45, 99, 100, 20, 88}},
         {9, 256, 512, {56, 100, 100, 28, 91}},
         {10, 256, 1024, {44, 99, 100, 20, 88}},
         {11, 512, 512, {80, 100, 100, 52, 91}},
         {12, 512, 1024, {45, 100, 100, 19, 88}},
         {13, 768, 512, {55, 100, 100, 28, 91}},
         {14, 768, 1024, {45, 100, 100, 19, 88}},
         {15, 1024, 1024, {45, 100, 100, 19, 88}}
        }};
    // clang-format on
    return table;
}

json run_table(PublishedTable const& table, StudyOptions const& study) {
    StudyOptions options = study;
    std::erase(options.methods, "framed"); // it is run in any case: the others are divided by it
    FigureTable const progress({{"method", "/method", -17},
                                {"run", "/run", 3, 0},
                                {"batch", "/batch", 5, 0},
                                {"side", "/side", 5, 0},
                                {"scene", "/scene", -17},
                                {"published %", "/published_percentile", 11, 0},
                                {"suit. %", "/suitable_percentile", 7, 0},
                                {"median", "/median_ratio", 8, 3},
                                {"server s", "/cpu_seconds/server", 8},
                                {"viewer s", "/cpu_seconds/viewer", 8, 3},
                                {"framed srv", "/framed_cpu_seconds/server", 10},
                                {"framed view", "/framed_cpu_seconds/viewer", 11, 3}});
    json cells = json::array();
    for (std::filesystem::path const& file : options.scenes) {
        json const of_scene = run_scene(table, *load_bench_scene(file), options, progress);
        cells.insert(cells.end(), of_scene.begin(), of_scene.end());
    }
    for (std::string const& method : options.methods) {
        print_table(table, cells, method);
    }
    return {{"counting", "total"},
            {"seconds", options.run.seconds},
            {"reference_rate", options.run.reference_rate},
            {"samples_per_pixel_and_second", options.run.frames_per_second},
            {"seed", options.run.seed},
            {"cells", cells}};
}

} // namespace framelet::bench
