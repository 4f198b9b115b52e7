#include "tests/evaluation/ablation.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/evaluation/figure_table.h"
#include "tests/evaluation/measures/measures.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

LinkParameters const narrow{.bits_per_second = 5e6, .delay_seconds = 0.02};

struct Part {
    char const* name;
    bool FrameletParts::*left_out; ///< null: nothing
    bool on_link_only = false; ///< does nothing where no link limits
};

constexpr Part parts[] = {
    {"whole", nullptr},
    {"spacing", &FrameletParts::spacing},
    {"price", &FrameletParts::price},
    {"probes", &FrameletParts::probes},
    {"inspections", &FrameletParts::inspections},
    {"withholding", &FrameletParts::withholding},
    {"reprojection", &FrameletParts::reprojection},
    {"link budget", &FrameletParts::link_budget, true},
    {"loss", &FrameletParts::loss, true},
};

json run_without(Part const& part, Subject const& subject, CostTable const& costs) {
    RunParameters const& parameters = subject.run;
    MethodSetup setup = method_setup(parameters, subject.machine, costs);
    if (part.left_out != nullptr) {
        setup.parts.*part.left_out = false;
    }
    auto const method = make_method("framelet", setup);
    double mse = 0;
    auto const count = static_cast<double>(reference_count(parameters));
    RunResult const run = run_method(*subject.scene, *method, parameters, subject.machine,
                                     [&](std::size_t index, Picture const& shown, double) {
                                         mse += mean_squared_error(shown, subject.reference.picture(index)) / count;
                                     });
    return {{"scene", subject.scene->name},
            {"link", parameters.link.bits_per_second > 0 ? "link" : "free"},
            {"part", part.name},
            {"mse", mse},
            {"bytes_per_second", static_cast<double>(run.bytes) / parameters.seconds},
            {"server_seconds", run.cpu.server() / parameters.seconds},
            {"response_seconds", run.cpu.response / parameters.seconds},
            {"viewer_seconds", run.cpu.viewer() / parameters.seconds}};
}

/// Of two errors or costs; both nothing: 1.
double ratio_of(double value, double whole) {
    constexpr double least = 1e-9;
    return std::max(value, least) / std::max(whole, least);
}

/// Of each part over all runs: least, geometric mean and greatest ratio of errors.
void print_summary(json const& rows) {
    std::printf("\n");
    FigureTable const table(
        {{"without", "/part", -14}, {"least", "/least", 8}, {"mean", "/mean", 8}, {"greatest", "/greatest", 8}});
    for (Part const& part : parts) {
        double least = INFINITY, greatest = 0, sum = 0, count = 0;
        for (json const& row : rows) {
            if (row["part"] == part.name) {
                double const ratio = row["ratio"]["mse"];
                least = std::min(least, ratio);
                greatest = std::max(greatest, ratio);
                sum += std::log(ratio);
                ++count;
            }
        }
        table.print({{"part", part.name}, {"least", least}, {"mean", std::exp(sum / count)}, {"greatest", greatest}});
    }
}

/// A row for the whole, and one without each part that does something there.
void measure_run(Subject const& subject, StudyOptions const& study, FigureTable const& table, json& rows) {
    bool const limited = subject.run.link.bits_per_second > 0;
    json of_whole;
    for (Part const& part : parts) {
        if (!limited && part.on_link_only) {
            continue;
        }
        json row = run_without(part, subject, study.costs);
        of_whole = part.left_out == nullptr ? row : of_whole;
        for (char const* const figure :
             {"mse", "bytes_per_second", "server_seconds", "response_seconds", "viewer_seconds"}) {
            row["ratio"][figure] = ratio_of(row[figure], of_whole[figure]);
        }
        table.print(row);
        rows.push_back(std::move(row));
    }
}

} // namespace

json measure_ablation(StudyOptions const& study) {
    FigureTable const table({{"scene", "/scene", -17},
                             {"link", "/link", -4},
                             {"without", "/part", -14},
                             {"mse", "/mse", 9, 2, 1, true},
                             {"kB/s", "/bytes_per_second", 8, 0, 1e-3},
                             {"server", "/server_seconds", 7, 3},
                             {"viewer", "/viewer_seconds", 7, 3},
                             {"x mse", "/ratio/mse", 7},
                             {"x bytes", "/ratio/bytes_per_second", 7},
                             {"x server", "/ratio/server_seconds", 8},
                             {"x viewer", "/ratio/viewer_seconds", 8}});
    json rows = json::array();
    for (std::filesystem::path const& file : study.scenes) {
        Subject subject = prepare(file, study);
        for (LinkParameters const& link : {LinkParameters{}, narrow}) {
            subject.run.link = link;
            measure_run(subject, study, table, rows);
        }
    }
    print_summary(rows);
    return {{"viewport", {study.run.viewport.width, study.run.viewport.height}},
            {"seconds", study.run.seconds},
            {"samples_per_pixel_and_second", study.run.frames_per_second},
            {"link", {{"bits_per_second", narrow.bits_per_second}, {"delay_seconds", narrow.delay_seconds}}},
            {"rows", rows}};
}

} // namespace framelet::bench
