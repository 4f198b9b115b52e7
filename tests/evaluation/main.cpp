// framelet-bench: measures the renderer, one verb a question.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "common/error.h"
#include "tests/evaluation/ablation.h"
#include "tests/evaluation/antialiasing.h"
#include "tests/evaluation/calibrate.h"
#include "tests/evaluation/codec/codec_study.h"
#include "tests/evaluation/correspondence/correspondence.h"
#include "tests/evaluation/estimators/estimator_verbs.h"
#include "tests/evaluation/layer_study.h"
#include "tests/evaluation/limits.h"
#include "tests/evaluation/link_table.h"
#include "tests/evaluation/link_turn.h"
#include "tests/evaluation/response_cost.h"
#include "tests/evaluation/sensitivity.h"
#include "tests/evaluation/smoothness.h"
#include "tests/evaluation/stability.h"
#include "tests/evaluation/stillness.h"
#include "tests/evaluation/table.h"
#include "tests/evaluation/verbs.h"
#include "tests/evaluation/wall.h"

namespace {

using framelet::bench::BenchScene;
using nlohmann::json;

std::filesystem::path const source = FRAMELET_SOURCE_DIR;

/// How much a study measures where it is not told.
struct Scale {
    int size = 512; ///< side of the picture, pixels
    double seconds = 2;
    double rate = 120; ///< measurements a second
};

struct Options {
    std::filesystem::path scene = source / "scenes/vehicle_chase.glb";
    int camera = 0;
    std::string json_file;
    std::filesystem::path costs_file = source / "tests/evaluation/costs.json";
    bool quick = false;
    std::optional<int> size;
    std::optional<double> seconds, rate;
    double megabits = 0;
    double delay_ms = 0;
    double jitter_ms = 0;
    bool total = false;
    framelet::bench::StabilityOptions stability;
    framelet::bench::AblationOptions ablation;
    std::vector<int> table_runs;
    std::vector<std::string> table_scenes;
    framelet::bench::StudyOptions study;
    framelet::bench::EstimatorStudy estimators;
    framelet::bench::CodecStudy codec;
    framelet::bench::LayerStudy layers;
    framelet::bench::AntialiasingStudy antialiasing;
    framelet::bench::CorrespondenceStudy correspondence;
    framelet::bench::SmoothnessStudy smoothness;
    framelet::bench::StillnessStudy stillness;
    framelet::bench::LinkTableOptions link_table;
    framelet::bench::WallOptions wall{.server_threads =
                                          std::max(1, static_cast<int>(std::thread::hardware_concurrency()) - 1)};
};

void add_output_options(CLI::App& verb, Options& options) {
    verb.add_option("--json", options.json_file, "Write the figures to this file as well");
    verb.add_flag("--quick", options.quick, "Smaller pictures, less time");
}

void add_scene_options(CLI::App& verb, Options& options) {
    add_output_options(verb, options);
    verb.add_option("--scene", options.scene, "Scene file to measure with")->capture_default_str();
    verb.add_option("--camera", options.camera, "Which of its cameras, from 0")->capture_default_str();
}

void add_reference_options(CLI::App& verb, Options& options) {
    auto& study = options.study;
    verb.add_option("--rate", options.rate, "Measurements a second")->check(CLI::Range(1.0, 1000.0));
    verb.add_option("--reference-samples", study.samples_per_side, "Samples along a side of a reference's pixel")
        ->check(CLI::Range(1, 16))
        ->capture_default_str();
    verb.add_option("--reference-cache", study.reference_cache, "Folder that keeps references")->capture_default_str();
}

void add_time_options(CLI::App& verb, Options& options) {
    verb.add_option("--seconds", options.seconds, "Scene time that is measured")->check(CLI::Range(0.05, 600.0));
    add_reference_options(verb, options);
}

void add_size_option(CLI::App& verb, Options& options) {
    verb.add_option("--size", options.size,
                    "Side of the picture, pixels (default: 512 or less, as the verb has time for)")
        ->check(CLI::Range(16, 4096));
}

void add_study_options(CLI::App& verb, Options& options) {
    add_scene_options(verb, options);
    add_size_option(verb, options);
    add_time_options(verb, options);
}

void add_result_options(CLI::App& verb, Options& options) {
    verb.add_option("--costs", options.costs_file, "Table of stage costs (calibrate writes one)")
        ->capture_default_str();
    verb.add_option("--charts", options.study.charts, "Draw charts into this folder");
}

void add_machine_options(CLI::App& verb, Options& options) {
    auto& study = options.study;
    verb.add_option("--fps", study.run.frames_per_second,
                    "The server's speed: whole frames a second that framed reaches")
        ->check(CLI::Range(0.1, 1000.0))
        ->capture_default_str();
    verb.add_option("--bias", study.run.bias, "The viewer's wish: -1 (spatial fidelity) .. 1 (temporal)")
        ->check(CLI::Range(-1.0, 1.0))
        ->capture_default_str();
    verb.add_option("--seed", study.run.seed, "Of everything that is random")->capture_default_str();
    add_result_options(verb, options);
}

void add_method_options(CLI::App& verb, Options& options) {
    verb.add_option("--methods", options.study.methods, "Which methods (default: all)")
        ->delimiter(',')
        ->check(CLI::IsMember(framelet::bench::method_names()));
    add_machine_options(verb, options);
}

void add_link_options(CLI::App& verb, Options& options) {
    verb.add_option("--bandwidth", options.megabits, "The link's rate, Mbit/s; 0: unlimited")
        ->check(CLI::Range(0.0, 1e6))
        ->capture_default_str();
    verb.add_option("--delay", options.delay_ms, "The link's delay each way, ms")
        ->check(CLI::Range(0.0, 10000.0))
        ->capture_default_str();
    verb.add_option("--jitter", options.jitter_ms, "Up to so much more delay, ms")
        ->check(CLI::Range(0.0, 10000.0))
        ->capture_default_str();
}

void add_run_options(CLI::App& verb, Options& options) {
    add_study_options(verb, options);
    add_method_options(verb, options);
    add_link_options(verb, options);
    verb.add_flag("--total", options.total, "The viewer's work is charged to the server's processors");
}

void add_table_options(CLI::App& verb, Options& options) {
    add_output_options(verb, options);
    add_time_options(verb, options);
    add_method_options(verb, options);
    verb.add_option("--runs", options.table_runs, "Which runs of the table, by number (default: all)")->delimiter(',');
    verb.add_option("--scenes", options.table_scenes, "Which of its scenes, by name (default: all)")->delimiter(',');
}

void add_link_table_options(CLI::App& verb, Options& options) {
    add_output_options(verb, options);
    add_size_option(verb, options);
    add_time_options(verb, options);
    add_machine_options(verb, options);
    verb.add_option("--scenes", options.link_table.scenes, "Scene files (default: all of the project's)")
        ->delimiter(',');
    verb.add_option("--megabits", options.link_table.megabits, "Rates of the links, Mbit/s; 0: unlimited")
        ->delimiter(',')
        ->check(CLI::Range(0.0, 1e6))
        ->capture_default_str();
    verb.add_option("--round-trips", options.link_table.round_trips_ms, "Round trips of the links, ms")
        ->delimiter(',')
        ->check(CLI::Range(0.0, 10000.0))
        ->capture_default_str();
}

void add_stability_options(CLI::App& verb, Options& options) {
    auto& stability = options.stability;
    add_output_options(verb, options);
    add_size_option(verb, options);
    add_reference_options(verb, options);
    add_machine_options(verb, options);
    add_link_options(verb, options);
    verb.add_option("--scenes", stability.scenes, "Scenes with events, by name")->delimiter(',')->capture_default_str();
    verb.add_option("--batches", stability.batches, "Most framelets of a batch, one run each")
        ->delimiter(',')
        ->check(CLI::Range(std::size_t(1), framelet::max_batch_framelets))
        ->capture_default_str();
    verb.add_option("--factor", stability.factor, "Settled is what is within so many times its final level")
        ->check(CLI::Range(1.01, 100.0))
        ->capture_default_str();
}

void add_ablation_options(CLI::App& verb, Options& options) {
    add_output_options(verb, options);
    add_size_option(verb, options);
    add_time_options(verb, options);
    add_machine_options(verb, options);
    verb.add_option("--scene", options.ablation.scenes,
                    "Scene files to measure with (default: chase, flyby, fixed, stop, windmill, globe, dim)");
}

void add_codec_options(CLI::App& verb, Options& options) {
    add_output_options(verb, options);
    verb.add_option("--scene", options.codec.scenes, "Scene files (default: the five vehicle scenes)");
    verb.add_option("--fps", options.codec.corpus.frames_per_second,
                    "Samples a second, in whole pictures at one sample a pixel")
        ->check(CLI::Range(0.1, 1000.0))
        ->capture_default_str();
    verb.add_option("--charts", options.codec.charts, "Draw charts into this folder");
}

void add_layer_options(CLI::App& verb, Options& options) {
    add_output_options(verb, options);
    verb.add_option("--scene", options.layers.scenes, "Scene files to measure with (default: all of the project's)");
    verb.add_option("--pixels", options.layers.pixels, "How far off a sample may be shown")
        ->check(CLI::Range(0.01, 16.0))
        ->capture_default_str();
}

void add_antialiasing_options(CLI::App& verb, Options& options) {
    add_output_options(verb, options);
    verb.add_option("--scene", options.antialiasing.scenes,
                    "Scene files to measure with (default: all of the project's)");
}

void add_correspondence_options(CLI::App& verb, Options& options) {
    auto& study = options.correspondence;
    add_output_options(verb, options);
    verb.add_option("--scene", study.scenes, "Scene files to measure with (default: globe, windmill, the vehicles)");
    verb.add_option("--camera", study.camera, "Which of their cameras, from 0")->capture_default_str();
    verb.add_option("--ahead", study.ahead, "Seconds that pictures are moved ahead")
        ->delimiter(',')
        ->check(CLI::Range(0.0, 10.0))
        ->capture_default_str();
}

void add_smoothness_options(CLI::App& verb, Options& options) {
    auto& smoothness = options.smoothness;
    add_output_options(verb, options);
    add_size_option(verb, options);
    add_time_options(verb, options);
    add_machine_options(verb, options);
    add_link_options(verb, options);
    verb.add_option("--scene", smoothness.scenes,
                    "Scene files to measure with (default: chase, windmill, flicker, globe)");
    verb.add_option("--lags", smoothness.lags_ms, "How late the scene is shown, ms; 0: without smoothing")
        ->delimiter(',')
        ->check(CLI::Range(0.0, 1000.0))
        ->capture_default_str();
}

void add_stillness_options(CLI::App& verb, Options& options) {
    add_output_options(verb, options);
    add_size_option(verb, options);
    add_machine_options(verb, options);
    add_link_options(verb, options);
    verb.add_option("--scene", options.stillness.scenes, "Scene files to measure with (default: all of the project's)");
    verb.add_option("--seconds", options.seconds, "How long it is watched after the stop")
        ->check(CLI::Range(1.0, 600.0));
}

void add_wall_options(CLI::App& verb, Options& options) {
    add_study_options(verb, options);
    add_link_options(verb, options);
    add_result_options(verb, options);
    verb.add_option("--threads", options.wall.server_threads,
                    "Threads of the server; client and link need processors of their own")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    verb.add_option("--display-rate", options.wall.display_rate, "Frames a second that the client shows")
        ->check(CLI::Range(1.0, 240.0))
        ->capture_default_str();
}

void settle(Options& options, Scale const& scale) {
    auto& study = options.study;
    int const size = options.size.value_or(scale.size);
    study.run.viewport = {size, size};
    study.run.seconds = options.seconds.value_or(scale.seconds);
    study.run.reference_rate = options.rate.value_or(scale.rate);
    study.run.link.bits_per_second = 1e6 * options.megabits;
    study.run.link.delay_seconds = 1e-3 * options.delay_ms;
    study.run.link.jitter_seconds = 1e-3 * options.jitter_ms;
    study.run.link.seed = study.run.seed;
    study.run.counting = options.total ? framelet::bench::Counting::total : framelet::bench::Counting::server;
    study.costs = framelet::bench::read_cost_table(options.costs_file);
}

json table(Options& options) {
    namespace bench = framelet::bench;
    settle(options, {.seconds = 5, .rate = 10}); // the whole of every scene
    if (options.study.methods.empty()) {
        options.study.methods = {"afr", "framelet-unwarped"}; // cost is total: a display rate is none of its terms
    }
    auto const published = bench::read_published_table(source / "tests/evaluation/published_table_7_2.csv");
    auto part = bench::part_of(published, options.table_runs, options.table_scenes);
    if (options.quick) {
        std::erase_if(part.runs, [](bench::PublishedRun const& run) { return run.side > 256; });
    }
    if (part.runs.empty()) {
        throw framelet::InputError("--quick leaves none of these runs: it takes those of 256x256 pixels alone");
    }
    return bench::run_table(part, source / "scenes", options.study);
}

/// Whole frames as they are sent, the same moved by the viewer, and the project's own.
std::vector<std::string> const streamed_methods{"framed+h264", "framed+warp", "framelet"};

json turn(BenchScene& scene, Options& options) {
    settle(options, options.quick ? Scale{.size = 128, .seconds = 1, .rate = 60} : Scale{.size = 256, .rate = 60});
    if (options.study.methods.empty()) {
        options.study.methods = streamed_methods;
    }
    return turn_study(scene, options.study);
}

json stability(Options& options) {
    settle(options, options.quick ? Scale{.size = 96, .rate = 20} : Scale{.size = 256, .rate = 40});
    return framelet::bench::measure_stability(source / "scenes", options.stability, options.study);
}

json smoothness(Options& options) {
    settle(options, options.quick ? Scale{.size = 96, .seconds = 0.5, .rate = 60}
                                  : Scale{.size = 192, .seconds = 1, .rate = 60});
    auto& scenes = options.smoothness.scenes;
    if (scenes.empty()) {
        for (auto const* scene : {"vehicle_chase", "windmill", "flicker", "globe"}) {
            scenes.push_back(source / ("scenes/" + std::string(scene) + ".glb"));
        }
    }
    return framelet::bench::measure_smoothness(options.smoothness, options.study);
}

json ablation(Options& options) {
    settle(options, options.quick ? Scale{.size = 128, .seconds = 0.5, .rate = 60} : Scale{.size = 256, .seconds = 1});
    auto& scenes = options.ablation.scenes;
    if (scenes.empty()) {
        for (auto const* scene :
             {"vehicle_chase", "vehicle_flyby", "vehicle_fixed", "stop", "windmill", "globe", "dim"}) {
            scenes.push_back(source / ("scenes/" + std::string(scene) + ".glb"));
        }
    }
    return framelet::bench::measure_ablation(options.ablation, options.study);
}

json codec(Options& options) {
    framelet::bench::CodecStudy& study = options.codec;
    if (study.scenes.empty()) {
        for (auto const* scene : {"approach", "chase", "crossing", "fixed", "flyby"}) {
            study.scenes.push_back(source / ("scenes/vehicle_" + std::string(scene) + ".glb"));
        }
    }
    if (options.quick) {
        study.corpus.viewport = {640, 360};
        study.corpus.moments = 1;
        study.rounds = 1;
    }
    return compare_codecs(study);
}

std::vector<std::filesystem::path> bundled_scenes() {
    std::vector<std::filesystem::path> files;
    for (auto const& entry : std::filesystem::directory_iterator(source / "scenes")) {
        if (entry.path().extension() == ".glb") {
            files.push_back(entry.path());
        }
    }
    std::ranges::sort(files);
    return files;
}

json links(Options& options) {
    settle(options, options.quick ? Scale{.size = 96, .seconds = 0.5, .rate = 20}
                                  : Scale{.size = 256, .seconds = 1, .rate = 30});
    if (options.link_table.scenes.empty()) {
        options.link_table.scenes = bundled_scenes();
    }
    return link_table(options.link_table, options.study);
}

json antialiasing(Options& options) {
    auto& study = options.antialiasing;
    if (study.scenes.empty()) {
        study.scenes = bundled_scenes();
    }
    if (options.quick) {
        study.viewport = {256, 256};
    }
    return framelet::bench::compare_sample_places(study);
}

json correspondence(Options& options) {
    auto& study = options.correspondence;
    if (study.scenes.empty()) {
        for (auto const* scene : {"globe", "windmill", "vehicle_approach", "vehicle_chase", "vehicle_crossing",
                                  "vehicle_fixed", "vehicle_flyby"}) {
            study.scenes.push_back(source / ("scenes/" + std::string(scene) + ".glb"));
        }
    }
    if (options.quick) {
        study.viewport = {640, 360};
        study.times = 1;
    }
    return framelet::bench::measure_correspondence(study);
}

json stillness(Options& options) {
    settle(options,
           options.quick ? Scale{.size = 128, .seconds = 2, .rate = 20} : Scale{.size = 512, .seconds = 4, .rate = 20});
    if (options.stillness.scenes.empty()) {
        options.stillness.scenes = bundled_scenes();
    }
    return framelet::bench::measure_stillness(options.stillness, options.study);
}

json layers(Options& options) {
    auto& study = options.layers;
    if (study.scenes.empty()) {
        study.scenes = bundled_scenes();
    }
    if (options.quick) {
        study.viewport = {640, 360};
        study.times = 2;
    }
    return framelet::bench::measure_layers(study);
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
    CLI::App app("Measures framelet: each verb answers one question.", "framelet-bench");
    app.set_version_flag("--version", "framelet-bench " FRAMELET_VERSION);
    app.require_subcommand(1);
    std::function<json()> answer;
    auto const add_verb = [&](char const* name, char const* question, auto add_options, auto run) {
        CLI::App& verb = *app.add_subcommand(name, question);
        add_options(verb, options);
        verb.callback([&answer, run] { answer = run; });
    };
    auto const add_estimator_verb = [&](char const* name, char const* question, auto run) {
        CLI::App& verb = *app.add_subcommand(name, question);
        verb.add_option("--json", options.json_file, "Write the figures to this file as well");
        framelet::bench::add_estimator_options(verb, options.estimators);
        verb.callback([&, run] { answer = [&options, run] { return run(options.estimators); }; });
    };
    auto const with_scene = [&options](auto run) {
        return [&options, run] { return run(*framelet::bench::load_bench_scene(options.scene, options.camera)); };
    };
    auto const study = [&options, &with_scene](auto run) {
        return with_scene([&options, run](BenchScene& scene) {
            settle(options, options.quick ? Scale{.size = 256, .seconds = 1} : Scale{});
            if (options.study.methods.empty()) {
                options.study.methods = framelet::bench::method_names();
            }
            return run(scene, options.study);
        });
    };
    add_verb("compare", "Error over time and cost of every method, beside the reference", add_run_options,
             study(framelet::bench::compare));
    add_verb("pareto", "Error against server CPU, bytes and delay", add_run_options, study(framelet::bench::pareto));
    add_verb("link", "Error against the link's rate, delay and stalls", add_run_options,
             study(framelet::bench::link_study));
    add_verb("turn", "Error and lag against the round trip while the camera turns", add_run_options,
             with_scene([&options](BenchScene& scene) { return turn(scene, options); }));
    add_verb("links", "The project's error beside coded whole frames', for every scene on several links",
             add_link_table_options, [&options] { return links(options); });
    add_verb("table", "Runs and scenes of the dissertation's Table 7.2 (--quick: those of 256x256)", add_table_options,
             [&options] { return table(options); });
    add_verb("stability", "How the loop of error, density and tiling settles after events, and how steady it is then",
             add_stability_options, [&options] { return stability(options); });
    add_verb("ablation", "What each part of framelet buys, and what it costs: error, bytes and work without it",
             add_ablation_options, [&options] { return ablation(options); });
    add_verb("wall", "The real server and client through an emulated link, beside what the virtual clock predicts",
             add_wall_options, study([&options](BenchScene& scene, framelet::bench::StudyOptions const& settled) {
                 return framelet::bench::measure_wall(scene, settled, options.wall);
             }));
    add_verb("reference", "Renders what the methods are compared with", add_study_options,
             study(framelet::bench::prepare_reference));
    add_verb("sensitivity", "How tsar answers to steeper and flatter templates of its error estimate", add_run_options,
             study(framelet::bench::sensitivity));
    add_verb("antialiasing", "What regular and jittered samples give for the same number of them",
             add_antialiasing_options, [&options] { return antialiasing(options); });
    add_verb("layers", "How many planes framelets are, how far off those show samples, and what finding them costs",
             add_layer_options, [&options] { return layers(options); });
    add_verb("correspondence", "How far off the viewer shows what it moves", add_correspondence_options,
             [&options] { return correspondence(options); });
    add_verb("smoothness",
             "How steadily the scene moves where the viewer shows it a little late, and how far off that is",
             add_smoothness_options, [&options] { return smoothness(options); });
    add_verb("stillness", "How good the picture gets once everything stands still, how soon, and what is sent then",
             add_stillness_options, [&options] { return stillness(options); });
    add_verb("calibrate", "What every stage costs on this machine", add_scene_options,
             with_scene([&options](BenchScene& scene) { return calibrate(scene, options.quick); }));
    add_verb("codec", "Bytes of a sample against the error of what is decoded, for each way of coding framelets",
             add_codec_options, [&options] { return codec(options); });
    add_verb("limits", "Each stage against its bare limit", add_scene_options,
             with_scene([&options](BenchScene& scene) {
                 framelet::bench::LimitsOptions limits;
                 if (options.quick) {
                     limits = {{640, 360}, 3};
                 }
                 return framelet::bench::measure_limits(scene, limits);
             }));
    add_verb(
        "response", "What response, tiling and selection cost for pictures of 256 to 4096 pixels",
        [](CLI::App& verb, Options& o) {
            add_scene_options(verb, o);
            verb.add_option("--charts", o.study.charts, "Draw charts into this folder");
        },
        with_scene([&options](BenchScene& scene) {
            framelet::bench::ResponseStudy sizes{.charts = options.study.charts};
            if (options.quick) {
                sizes.sides = {256, 1024};
                sizes.seconds = 0.3;
            }
            return framelet::bench::measure_response(scene, sizes);
        }));
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
