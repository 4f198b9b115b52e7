#include "tests/evaluation/ablation.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/picture_writer.h"
#include "tests/evaluation/charts/charts.h"
#include "tests/evaluation/charts/picture_sheet.h"
#include "tests/evaluation/measures/measures.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

struct Part {
    char const* name;
    bool FrameletParts::*left_out; ///< null: nothing
    bool on_link = true; ///< does something on a link that limits
    bool off_link = true; ///< likewise where nothing does
};

constexpr Part parts[] = {
    {"whole", nullptr},
    {"spacing", &FrameletParts::spacing},
    {"price", &FrameletParts::price},
    {"probes", &FrameletParts::probes},
    {"inspections", &FrameletParts::inspections},
    {"withholding", &FrameletParts::withholding},
    {"reprojection", &FrameletParts::reprojection},
    {"link budget", &FrameletParts::link_budget, true, false},
    {"loss", &FrameletParts::loss, true, false},
};

struct Outcome {
    double mse = 0, bytes = 0, server = 0, response = 0, viewer = 0; ///< mean, a second's, CPU seconds a second
    Picture picture; ///< in the middle of the run
};

std::size_t middle_of(RunParameters const& parameters) {
    return reference_count(parameters) / 2;
}

Outcome run_without(Part const& part, Subject const& subject, CostTable const& costs) {
    RunParameters const& parameters = subject.run;
    MethodSetup setup = method_setup(parameters, subject.machine, costs);
    if (part.left_out != nullptr) {
        setup.parts.*part.left_out = false;
    }
    auto const method = make_method("framelet", setup);
    Outcome result;
    auto const count = static_cast<double>(reference_count(parameters));
    RunResult const run = run_method(
        *subject.scene, *method, parameters, subject.machine, [&](std::size_t index, Picture const& shown, double) {
            result.mse += mean_squared_error(shown, subject.reference.picture(index)) / count;
            if (index == middle_of(parameters)) {
                result.picture = shown;
            }
        });
    result.bytes = static_cast<double>(run.bytes) / parameters.seconds;
    result.server = run.cpu.server() / parameters.seconds;
    result.response = run.cpu.response / parameters.seconds;
    result.viewer = run.cpu.viewer() / parameters.seconds;
    return result;
}

/// Of two errors or costs; both nothing: 1.
double ratio_of(double value, double whole) {
    constexpr double least = 1e-9;
    return std::max(value, least) / std::max(whole, least);
}

void draw_chart(json const& runs, std::filesystem::path const& folder) {
    Curves chart{.title = "error without each part, as a multiple of the whole's",
                 .x_title = "scene and link, as listed",
                 .y_title = "ratio of mean squared errors",
                 .log_y = true,
                 .curves = {}};
    for (std::size_t i = 0; i < runs.size(); ++i) {
        for (json const& without : runs[i]["without"]) {
            std::string const name = without["part"];
            auto found = std::ranges::find(chart.curves, name, &Curve::name);
            if (found == chart.curves.end()) {
                found = chart.curves.insert(chart.curves.end(), {name, {}, {}});
            }
            found->x.push_back(static_cast<double>(i + 1));
            found->y.push_back(without["mse_ratio"]);
        }
    }
    draw(chart, folder / "ablation");
}

/// Of each part over all runs: least, geometric mean and greatest ratio of errors.
void print_summary(json const& runs) {
    std::printf("\n%-14s %8s %8s %8s\n", "without", "least", "mean", "greatest");
    for (Part const& part : parts) {
        double least = INFINITY, greatest = 0, sum = 0, count = 0;
        for (json const& run : runs) {
            for (json const& without : run["without"]) {
                if (without["part"] == part.name) {
                    double const ratio = without["mse_ratio"];
                    least = std::min(least, ratio);
                    greatest = std::max(greatest, ratio);
                    sum += std::log(ratio);
                    ++count;
                }
            }
        }
        if (count > 0) {
            std::printf("%-14s %8.2f %8.2f %8.2f\n", part.name, least, std::exp(sum / count), greatest);
        }
    }
}

/// `pictures` gets what is shown in the middle of each run.
json measure_run(Subject const& subject, CostTable const& costs, std::vector<Picture>& pictures) {
    double const rate = subject.run.link.bits_per_second;
    bool const limited = rate > 0;
    json result{{"scene", subject.scene->name}, {"bits_per_second", rate}};
    Outcome whole;
    for (Part const& part : parts) {
        if (limited ? !part.on_link : !part.off_link) {
            continue;
        }
        Outcome const found = run_without(part, subject, costs);
        pictures.push_back(found.picture);
        if (part.left_out == nullptr) {
            whole = found;
            result["whole"] = {{"mse", found.mse},
                               {"bytes_per_second", found.bytes},
                               {"server_seconds", found.server},
                               {"response_seconds", found.response},
                               {"viewer_seconds", found.viewer}};
            std::printf("%-17s %5s %-14s %9.2e %8.0f %7.3f %9.3f\n", subject.scene->name.c_str(),
                        limited ? "link" : "free", part.name, found.mse, 1e-3 * found.bytes, found.server,
                        found.viewer);
            continue;
        }
        json const ratios{{"part", part.name},
                          {"mse_ratio", ratio_of(found.mse, whole.mse)},
                          {"bytes_ratio", ratio_of(found.bytes, whole.bytes)},
                          {"server_ratio", ratio_of(found.server, whole.server)},
                          {"response_ratio", ratio_of(found.response, whole.response)},
                          {"viewer_ratio", ratio_of(found.viewer, whole.viewer)}};
        std::printf("%-17s %5s %-14s %8.2fx %7.2fx %6.2fx %8.2fx\n", "", "", part.name,
                    ratios["mse_ratio"].get<double>(), ratios["bytes_ratio"].get<double>(),
                    ratios["server_ratio"].get<double>(), ratios["viewer_ratio"].get<double>());
        result["without"].push_back(ratios);
    }
    std::fflush(stdout); // whoever reads a pipe wants to see it grow
    return result;
}

} // namespace

json measure_ablation(AblationOptions const& options, StudyOptions const& study) {
    std::printf("%-17s %5s %-14s %9s %8s %7s %9s\n", "scene", "link", "without", "mse", "kB/s", "server", "viewer");
    json runs = json::array();
    if (!study.charts.empty()) {
        std::filesystem::create_directories(study.charts);
    }
    for (std::filesystem::path const& file : study.scenes) {
        Subject subject = prepare(file, study);
        for (LinkParameters const& link : {LinkParameters{}, options.link}) {
            subject.run.link = link;
            std::vector<Picture> pictures;
            runs.push_back(measure_run(subject, study.costs, pictures));
            if (!study.charts.empty()) {
                std::string const end = link.bits_per_second > 0 ? "-parts-link.png" : "-parts.png";
                write_png(study.charts / (subject.scene->name + end),
                          beside_reference(subject.reference.picture(middle_of(subject.run)), pictures));
            }
        }
    }
    print_summary(runs);
    if (!study.charts.empty()) {
        draw_chart(runs, study.charts);
    }
    return {
        {"viewport", {study.run.viewport.width, study.run.viewport.height}},
        {"seconds", study.run.seconds},
        {"samples_per_pixel_and_second", study.run.frames_per_second},
        {"link", {{"bits_per_second", options.link.bits_per_second}, {"delay_seconds", options.link.delay_seconds}}},
        {"runs", runs}};
}

} // namespace framelet::bench
