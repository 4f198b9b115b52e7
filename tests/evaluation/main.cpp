// framelet-bench: measures the renderer, one verb a question.
#include <fstream>
#include <functional>
#include <iostream>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "common/error.h"
#include "tests/evaluation/calibrate.h"
#include "tests/evaluation/estimators/estimator_verbs.h"
#include "tests/evaluation/limits.h"
#include "tests/evaluation/sensitivity.h"
#include "tests/evaluation/verbs.h"

namespace {

using framelet::bench::BenchScene;
using nlohmann::json;

struct Options {
    std::string scene = FRAMELET_SOURCE_DIR "/scenes/vehicle_chase.glb";
    int camera = 0;
    std::string json_file;
    std::string costs_file = FRAMELET_SOURCE_DIR "/tests/evaluation/costs.json";
    bool quick = false;
    int size = 512;
    double megabits = 0;
    double delay_ms = 0;
    double jitter_ms = 0;
    bool total = false;
    framelet::bench::StudyOptions study;
    framelet::bench::EstimatorStudy estimators;
};

void add_common_options(CLI::App& verb, Options& options) {
    verb.add_option("--scene", options.scene, "Scene file to measure with")->capture_default_str();
    verb.add_option("--camera", options.camera, "Which of its cameras, from 0")->capture_default_str();
    verb.add_option("--json", options.json_file, "Write the figures to this file as well");
    verb.add_flag("--quick", options.quick, "Smaller pictures, less time");
}

void add_study_options(CLI::App& verb, Options& options) {
    auto& study = options.study;
    add_common_options(verb, options);
    verb.add_option("--size", options.size, "Side of the picture, pixels (--quick: 256)")
        ->check(CLI::Range(16, 4096))
        ->capture_default_str();
    verb.add_option("--seconds", study.run.seconds, "Scene time that is measured (--quick: 1)")
        ->check(CLI::Range(0.05, 600.0))
        ->capture_default_str();
    verb.add_option("--rate", study.run.reference_rate, "Measurements a second")
        ->check(CLI::Range(1.0, 1000.0))
        ->capture_default_str();
    verb.add_option("--reference-samples", study.samples_per_side, "Samples along a side of a reference's pixel")
        ->check(CLI::Range(1, 16))
        ->capture_default_str();
    verb.add_option("--reference-cache", study.reference_cache, "Folder that keeps references")->capture_default_str();
}

void add_run_options(CLI::App& verb, Options& options) {
    auto& study = options.study;
    add_study_options(verb, options);
    study.methods = framelet::bench::method_names();
    verb.add_option("--methods", study.methods, "Which methods")->delimiter(',')->capture_default_str();
    verb.add_option("--fps", study.run.frames_per_second,
                    "The server's speed: whole frames a second that framed reaches")
        ->check(CLI::Range(0.1, 1000.0))
        ->capture_default_str();
    verb.add_option("--bandwidth", options.megabits, "The link's rate, Mbit/s; 0: unlimited")
        ->check(CLI::Range(0.0, 1e6))
        ->capture_default_str();
    verb.add_option("--delay", options.delay_ms, "The link's delay each way, ms")
        ->check(CLI::Range(0.0, 10000.0))
        ->capture_default_str();
    verb.add_option("--jitter", options.jitter_ms, "Up to so much more delay, ms")
        ->check(CLI::Range(0.0, 10000.0))
        ->capture_default_str();
    verb.add_flag("--total", options.total, "The viewer's work is charged to the server's processors");
    verb.add_option("--seed", study.run.seed, "Of everything that is random")->capture_default_str();
    verb.add_option("--costs", options.costs_file, "Table of stage costs (calibrate writes one)")
        ->capture_default_str();
    verb.add_option("--charts", study.charts, "Draw charts into this folder");
}

void settle(Options& options) {
    auto& study = options.study;
    if (options.quick) {
        options.size = 256;
        study.run.seconds = 1;
    }
    study.run.viewport = {options.size, options.size};
    study.run.link.bits_per_second = 1e6 * options.megabits;
    study.run.link.delay_seconds = 1e-3 * options.delay_ms;
    study.run.link.jitter_seconds = 1e-3 * options.jitter_ms;
    study.run.link.seed = study.run.seed;
    study.run.counting = options.total ? framelet::bench::Counting::total : framelet::bench::Counting::server;
    study.costs = framelet::bench::read_cost_table(options.costs_file);
}

json calibrate(BenchScene& scene, bool quick) {
    json const costs = to_json(framelet::bench::calibrate(scene, {512, 512}, quick ? 3 : 15));
    for (auto const& [name, cost] : costs.items()) {
        std::printf("%-26s %8.2f ns\n", name.c_str(), cost.get<double>());
    }
    return costs;
}

void write_json(std::string const& file, json const& figures) {
    std::ofstream stream(file);
    stream << figures.dump(2) << '\n';
    if (!stream.flush()) {
        throw framelet::InputError("cannot write '" + file + "'");
    }
}

} // namespace

int main(int argc, char** argv) {
    Options options;
    options.study.run.seconds = 2;
    CLI::App app("Measures framelet: each verb answers one question.", "framelet-bench");
    app.set_version_flag("--version", "framelet-bench " FRAMELET_VERSION);
    app.require_subcommand(1);
    std::function<json()> answer;
    auto const add_verb = [&](char const* name, char const* question, auto add_options, auto run) {
        CLI::App& verb = *app.add_subcommand(name, question);
        add_options(verb, options);
        verb.callback([&, run] {
            answer = [&options, run] { return run(*framelet::bench::load_bench_scene(options.scene, options.camera)); };
        });
    };
    auto const add_estimator_verb = [&](char const* name, char const* question, auto run) {
        CLI::App& verb = *app.add_subcommand(name, question);
        verb.add_option("--json", options.json_file, "Write the figures to this file as well");
        framelet::bench::add_estimator_options(verb, options.estimators);
        verb.callback([&, run] { answer = [&options, run] { return run(options.estimators); }; });
    };
    auto const study = [&options](auto run) {
        return [&options, run](BenchScene& scene) {
            settle(options);
            return run(scene, options.study);
        };
    };
    add_verb("compare", "Error over time and cost of every method, beside the reference", add_run_options,
             study(framelet::bench::compare));
    add_verb("pareto", "Error against server CPU, bytes and delay", add_run_options, study(framelet::bench::pareto));
    add_verb("link", "Error against the link's rate, delay and stalls", add_run_options,
             study(framelet::bench::link_study));
    add_verb("reference", "Renders what the methods are compared with", add_study_options,
             study(framelet::bench::prepare_reference));
    add_verb("sensitivity", "How tsar answers to steeper and flatter templates of its error estimate", add_run_options,
             study(framelet::bench::sensitivity));
    add_verb("calibrate", "What every stage costs on this machine", add_common_options,
             [&options](BenchScene& scene) { return calibrate(scene, options.quick); });
    add_verb("limits", "Each stage against its bare limit", add_common_options, [&options](BenchScene& scene) {
        framelet::bench::LimitsOptions limits;
        if (options.quick) {
            limits = {{640, 360}, 3};
        }
        return framelet::bench::measure_limits(scene, limits);
    });
    add_estimator_verb("estimators", "Cost of error estimators against their agreement with the ideal density",
                       framelet::bench::compare_estimators);
    add_estimator_verb("fit", "Fits the templates of the error estimators", framelet::bench::fit_estimators);
    try {
        app.parse(argc, argv);
    } catch (CLI::CallForHelp const& help) {
        return app.exit(help);
    } catch (CLI::CallForVersion const& version) {
        return app.exit(version);
    } catch (CLI::ParseError const& error) {
        std::cerr << "framelet-bench: " << error.what() << " (--help lists the verbs and options)\n";
        return 2;
    }
    spdlog::set_level(spdlog::level::warn);
    try {
        json const figures = answer();
        if (!options.json_file.empty()) {
            write_json(options.json_file, figures);
        }
        return 0;
    } catch (std::exception const& error) {
        std::cerr << "framelet-bench: " << error.what() << '\n';
        return 1;
    }
}
