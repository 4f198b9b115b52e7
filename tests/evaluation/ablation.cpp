#include "tests/evaluation/ablation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/evaluation/figure_table.h"
#include "tests/evaluation/measures/measures.h"
#include "tests/evaluation/phases.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

LinkParameters const usual_link{.bits_per_second = 5e6, .delay_seconds = 0.02};

struct Part {
    char const* name;
    bool FrameletParts::*left_out; ///< null: nothing is left out
    bool on_link_only = false; ///< the part does nothing where no link limits
};

constexpr Part parts[] = {
    {"whole", nullptr},
    {"spacing", &FrameletParts::spacing},
    {"probes", &FrameletParts::probes},
    {"skip", &FrameletParts::skip},
    {"reprojection", &FrameletParts::reprojection},
    {"few moments", &FrameletParts::few_moments},
    {"look ahead", &FrameletParts::look_ahead},
    {"awaited switches", &FrameletParts::awaited_switches},
    {"camera lead", &FrameletParts::camera_lead},
    {"visibility", &FrameletParts::visibility},
    {"planned together", &FrameletParts::planned_together},
    {"coarse first", &FrameletParts::coarse_first},
    {"four rays", &FrameletParts::four_rays},
    {"restlessness", &FrameletParts::restlessness},
    {"rest", &FrameletParts::rest},
    {"held moments", &FrameletParts::held_moments},
    {"outline filter", &FrameletParts::outline_filter},
    {"kept cuts", &FrameletParts::kept_cuts},
    {"loss", &FrameletParts::loss},
    {"predictions", &FrameletParts::predictions},
    {"link budget", &FrameletParts::link_budget, true},
    {"byte prices", &FrameletParts::byte_prices, true},
};

/// Mean errors of each phase, and what all of them together cost.
struct PartRun {
    std::array<double, phases> mse{};
    double flip = 0, bytes = 0;
    StageSeconds cpu;
};

/// FLIP is measured on one of so many pictures, since it takes longer than the run.
constexpr std::size_t flip_every = 4;

PartRun run_without(Part const& part, Subject const& subject, CostTable const& costs) {
    RunParameters const& parameters = subject.run;
    auto const pictures = static_cast<double>(reference_count(parameters));
    PartRun sum;
    std::vector<double> flip;
    for (std::size_t phase = 0; phase < phases; ++phase) {
        MethodSetup setup = method_setup(parameters, subject.machine, costs);
        setup.clock_offset += phase_step * static_cast<double>(phase);
        if (part.left_out != nullptr) {
            setup.parts.*part.left_out = false;
        }
        auto const method = make_method("framelet", setup);
        auto const compare = [&](std::size_t index, Picture const& shown, double) {
            Picture const& reference = subject.reference.picture(index);
            sum.mse[phase] += mean_squared_error(shown, reference) / pictures;
            if (index % flip_every == 0) {
                flip.push_back(mean_flip(shown, reference));
            }
        };
        RunResult const run = run_method(*subject.scene, *method, parameters, subject.machine, compare);
        sum.bytes += static_cast<double>(run.bytes);
        for (double StageSeconds::*const stage : {&StageSeconds::render, &StageSeconds::response, &StageSeconds::encode,
                                                  &StageSeconds::decode, &StageSeconds::reconstruct}) {
            sum.cpu.*stage += run.cpu.*stage;
        }
    }
    sum.flip = std::accumulate(flip.begin(), flip.end(), 0.0) / static_cast<double>(flip.size());
    return sum;
}

double mean_of(std::array<double, phases> const& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / phases;
}

/// Standard error of the mean error as a multiple of the whole's, from the phases.
double standard_error(std::array<double, phases> const& mse, std::array<double, phases> const& whole) {
    double const ratio = mean_of(mse) / mean_of(whole);
    double squares = 0;
    for (std::size_t i = 0; i < phases; ++i) {
        double const off = (mse[i] - ratio * whole[i]) / mean_of(whole);
        squares += off * off;
    }
    return std::sqrt(squares / (phases * (phases - 1)));
}

json row_of(Part const& part, PartRun const& run, Subject const& subject) {
    double const seconds = phases * subject.run.seconds;
    return {{"scene", subject.scene->name},
            {"link", subject.run.link.bits_per_second > 0 ? "link" : "free"},
            {"part", part.name},
            {"mse", mean_of(run.mse)},
            {"flip", run.flip},
            {"bytes_per_second", run.bytes / seconds},
            {"server_seconds", run.cpu.server() / seconds},
            {"response_seconds", run.cpu.response / seconds},
            {"viewer_seconds", run.cpu.viewer() / seconds}};
}

/// Ratio of two errors or costs; 1 where both are nothing.
double ratio_of(double value, double whole) {
    constexpr double least = 1e-9;
    return std::max(value, least) / std::max(whole, least);
}

/// The part of a bundled scene's name that tells it apart: `chase` of vehicle_chase; eight letters at most.
std::string short_name(std::string const& scene) {
    std::size_t const from = scene.rfind('_');
    return (from == std::string::npos ? scene : scene.substr(from + 1)).substr(0, 8);
}

/// Prints the ratios of errors of each part by scene; least, geometric mean and greatest.
void print_summary(json const& rows, std::string const& link) {
    std::vector<std::string> scenes, titles, figures;
    for (json const& row : rows) {
        std::string const scene = row["scene"];
        if (scenes.empty() || scenes.back() != scene) {
            scenes.push_back(scene);
            titles.push_back(short_name(scene));
            figures.push_back("/" + scene);
        }
    }
    std::vector<Column> columns{{"without", "/part", -16}};
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        columns.push_back({titles[i].c_str(), figures[i].c_str(), 8});
    }
    columns.insert(columns.end(), {{"least", "/least", 7}, {"mean", "/mean", 7}, {"greatest", "/greatest", 8}});
    std::printf("\nx mse, %s\n", link == "free" ? "no limit" : "over the link");
    FigureTable const table(columns);
    for (Part const& part : parts) {
        json line{{"part", part.name}};
        double least = INFINITY, greatest = 0, sum = 0, count = 0;
        for (json const& row : rows) {
            if (row["part"] == part.name && row["link"] == link) {
                double const ratio = row["ratio"]["mse"];
                line[row["scene"].get<std::string>()] = ratio;
                least = std::min(least, ratio);
                greatest = std::max(greatest, ratio);
                sum += std::log(ratio);
                ++count;
            }
        }
        if (count > 0) {
            line.update({{"least", least}, {"mean", std::exp(sum / count)}, {"greatest", greatest}});
            table.print(line);
        }
    }
}

bool is_chosen(Part const& part, std::vector<std::string> const& without) {
    return part.left_out == nullptr || without.empty() || std::ranges::find(without, part.name) != without.end();
}

/// Adds a row for the whole, and one without each part that does something in this run.
void measure_run(Subject const& subject, StudyOptions const& study, std::vector<std::string> const& without,
                 FigureTable const& table, json& rows) {
    bool const limited = subject.run.link.bits_per_second > 0;
    PartRun whole;
    json of_whole;
    for (Part const& part : parts) {
        if ((!limited && part.on_link_only) || !is_chosen(part, without)) {
            continue;
        }
        PartRun const run = run_without(part, subject, study.costs);
        json row = row_of(part, run, subject);
        if (part.left_out == nullptr) {
            whole = run;
            of_whole = row;
        }
        for (char const* const figure :
             {"mse", "flip", "bytes_per_second", "server_seconds", "response_seconds", "viewer_seconds"}) {
            row["ratio"][figure] = ratio_of(row[figure], of_whole[figure]);
        }
        row["ratio"]["standard_error"] = standard_error(run.mse, whole.mse);
        table.print(row);
        rows.push_back(std::move(row));
    }
}

} // namespace

std::vector<std::string> ablation_parts() {
    std::vector<std::string> names;
    for (Part const& part : parts) {
        if (part.left_out != nullptr) {
            names.emplace_back(part.name);
        }
    }
    return names;
}

json measure_ablation(StudyOptions const& study, std::vector<std::string> const& without) {
    FigureTable const table({{"scene", "/scene", -17},
                             {"link", "/link", -4},
                             {"without", "/part", -16},
                             {"mse", "/mse", 9, 2, 1, true},
                             {"kB/s", "/bytes_per_second", 8, 0, 1e-3},
                             {"server", "/server_seconds", 7, 3},
                             {"viewer", "/viewer_seconds", 7, 3},
                             {"x mse", "/ratio/mse", 7},
                             {"+-", "/ratio/standard_error", 5},
                             {"x flip", "/ratio/flip", 7},
                             {"x bytes", "/ratio/bytes_per_second", 7},
                             {"x server", "/ratio/server_seconds", 8},
                             {"x viewer", "/ratio/viewer_seconds", 8}});
    LinkParameters const limited = study.run.link.bits_per_second > 0 ? study.run.link : usual_link;
    json rows = json::array();
    for (std::filesystem::path const& file : study.scenes) {
        Subject subject = prepare(file, study);
        for (LinkParameters const& link : {LinkParameters{}, limited}) {
            subject.run.link = link;
            measure_run(subject, study, without, table, rows);
        }
    }
    print_summary(rows, "free");
    print_summary(rows, "link");
    return {{"viewport", {study.run.viewport.width, study.run.viewport.height}},
            {"seconds", study.run.seconds},
            {"samples_per_pixel_and_second", study.run.frames_per_second},
            {"link", {{"bits_per_second", limited.bits_per_second}, {"delay_seconds", limited.delay_seconds}}},
            {"phases", phases},
            {"rows", rows}};
}

} // namespace framelet::bench
