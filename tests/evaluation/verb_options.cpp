#include "tests/evaluation/verb_options.h"

#include <CLI/CLI.hpp>

#include "client/connection_arguments.h"
#include "common/error.h"
#include "tests/evaluation/method.h"

namespace framelet::bench {
namespace {

std::vector<std::string> const rival_part_names{"accumulation", "ahead", "spacing", "margin"};

void add_output_options(CLI::App& verb, VerbOptions& options) {
    verb.add_option("--json", options.json_file, "Write the figures to this file as well");
    verb.add_flag("--quick", options.quick, "Smaller pictures, less time");
}

void add_reference_options(CLI::App& verb, VerbOptions& options) {
    auto& study = options.study;
    verb.add_option("--rate", options.rate, "Measurements a second")->check(CLI::Range(1.0, 1000.0));
    verb.add_option("--reference-samples", study.samples_per_side, "Samples along a side of a reference's pixel")
        ->check(CLI::Range(1, 16))
        ->capture_default_str();
    verb.add_option("--reference-cache", study.reference_cache, "Folder that keeps references")->capture_default_str();
}

void add_time_options(CLI::App& verb, VerbOptions& options) {
    verb.add_option("--seconds", options.seconds, "Scene time that is measured")->check(CLI::Range(0.05, 600.0));
    add_reference_options(verb, options);
}

Viewport read_size(std::string const& text) {
    bool const is_side = text.find_first_not_of("0123456789") == std::string::npos;
    try {
        return parse_size(is_side ? text + "x" + text : text);
    } catch (InputError const& error) {
        throw CLI::ValidationError("--size", error.what());
    }
}

void add_size_option(CLI::App& verb, VerbOptions& options) {
    verb.add_option_function<std::string>(
        "--size", [&options](std::string const& text) { options.size = read_size(text); },
        "Size of the picture, WIDTHxHEIGHT or the side of a square, pixels (default: 512 or less, as the verb has time "
        "for)");
}

void add_result_options(CLI::App& verb, VerbOptions& options) {
    verb.add_option("--costs", options.costs_file, "Table of stage costs (calibrate writes one)")
        ->capture_default_str();
    verb.add_option("--charts", options.study.charts, "Draw charts into this folder");
}

void add_machine_options(CLI::App& verb, VerbOptions& options) {
    auto& study = options.study;
    verb.add_option("--fps", study.run.frames_per_second,
                    "The server's speed: whole frames a second that framed reaches")
        ->check(CLI::Range(0.1, 1000.0))
        ->capture_default_str();
    verb.add_option("--bias", study.run.bias, "The viewer's wish: -1 (spatial fidelity) .. 1 (temporal)")
        ->check(CLI::Range(-1.0, 1.0))
        ->capture_default_str();
    verb.add_option("--seed", study.run.seed, "Of everything that is random")->capture_default_str();
    verb.add_option("--rivals-without", options.rivals_without,
                    "What the rivals do not do, of accumulation, ahead, spacing and margin")
        ->delimiter(',')
        ->check(CLI::IsMember(rival_part_names));
    verb.add_option("--rivals-spacing", study.run.rivals.spacing,
                    "Pixels from sample to sample of whole frames while something moves (default: the best)")
        ->check(CLI::IsMember({1, 2, 4}));
    add_result_options(verb, options);
}

void add_method_options(CLI::App& verb, VerbOptions& options) {
    verb.add_option("--methods", options.study.methods, "Which methods (default: all)")
        ->delimiter(',')
        ->check(CLI::IsMember(method_names()));
    add_machine_options(verb, options);
}

void add_link_options(CLI::App& verb, VerbOptions& options) {
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

/// `scenes`: which are measured with by default.
template <class Study>
void add_ahead_options(CLI::App& verb, VerbOptions& options, Study& study, std::string const& scenes) {
    add_output_options(verb, options);
    verb.add_option("--scene", study.scenes, "Scene files to measure with (default: " + scenes + ")");
    verb.add_option("--camera", study.camera, "Which of their cameras, from 0")->capture_default_str();
    verb.add_option("--ahead", study.ahead, "Seconds that pictures are moved ahead")
        ->delimiter(',')
        ->check(CLI::Range(0.0, 10.0))
        ->capture_default_str();
}

} // namespace

void settle(VerbOptions& options, Scale const& scale) {
    auto& study = options.study;
    for (std::string const& part : options.rivals_without) {
        RivalParts& rivals = study.run.rivals;
        rivals.accumulate &= part != "accumulation";
        rivals.ahead &= part != "ahead";
        rivals.spacing = part == "spacing" ? 1 : rivals.spacing;
        rivals.margin = part == "margin" ? 0 : rivals.margin;
    }
    study.run.viewport = options.size.value_or(Viewport{scale.size, scale.size});
    study.run.seconds = options.seconds.value_or(scale.seconds);
    study.run.reference_rate = options.rate.value_or(scale.rate);
    study.run.link.bits_per_second = 1e6 * options.megabits;
    study.run.link.delay_seconds = 1e-3 * options.delay_ms;
    study.run.link.jitter_seconds = 1e-3 * options.jitter_ms;
    study.run.link.seed = study.run.seed;
    study.run.counting = options.total ? Counting::total : Counting::server;
    study.costs = read_cost_table(options.costs_file);
}

void add_scene_options(CLI::App& verb, VerbOptions& options) {
    add_output_options(verb, options);
    verb.add_option("--scene", options.scene, "Scene file to measure with")->capture_default_str();
    verb.add_option("--camera", options.camera, "Which of its cameras, from 0")->capture_default_str();
}

void add_study_options(CLI::App& verb, VerbOptions& options) {
    add_scene_options(verb, options);
    add_size_option(verb, options);
    add_time_options(verb, options);
}

void add_run_options(CLI::App& verb, VerbOptions& options) {
    add_study_options(verb, options);
    add_method_options(verb, options);
    add_link_options(verb, options);
    verb.add_flag("--total", options.total, "The viewer's work is charged to the server's processors");
}

void add_table_options(CLI::App& verb, VerbOptions& options) {
    add_output_options(verb, options);
    add_time_options(verb, options);
    add_method_options(verb, options);
    verb.add_option("--runs", options.table_runs, "Which runs of the table, by number (default: all)")->delimiter(',');
    verb.add_option("--scenes", options.table_scenes, "Which of its scenes, by name (default: all)")->delimiter(',');
}

void add_link_table_options(CLI::App& verb, VerbOptions& options) {
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

void add_stability_options(CLI::App& verb, VerbOptions& options) {
    auto& stability = options.stability;
    add_output_options(verb, options);
    add_size_option(verb, options);
    add_reference_options(verb, options);
    add_machine_options(verb, options);
    add_link_options(verb, options);
    verb.add_option("--scenes", stability.scenes, "Scenes with events, by name")->delimiter(',')->capture_default_str();
    verb.add_option("--batches", stability.batches, "Most framelets of a batch, one run each")
        ->delimiter(',')
        ->check(CLI::Range(std::size_t(1), max_batch_framelets))
        ->capture_default_str();
    verb.add_option("--factor", stability.factor, "Settled is what is within so many times its final level")
        ->check(CLI::Range(1.01, 100.0))
        ->capture_default_str();
}

void add_ablation_options(CLI::App& verb, VerbOptions& options) {
    add_output_options(verb, options);
    add_size_option(verb, options);
    add_time_options(verb, options);
    add_machine_options(verb, options);
    verb.add_option("--scene", options.ablation.scenes,
                    "Scene files to measure with (default: chase, flyby, fixed, stop, windmill, globe, dim)");
}

void add_codec_options(CLI::App& verb, VerbOptions& options) {
    add_output_options(verb, options);
    verb.add_option("--scene", options.codec.scenes, "Scene files (default: the five vehicle scenes)");
    verb.add_option("--viewport", options.codec_viewport,
                    "Width and height of the picture, pixels (default: 1280 720, with --quick 640 360)")
        ->expected(2)
        ->check(CLI::Range(16, 4096));
    verb.add_option("--codecs", options.codec.codecs, "Which ways of coding (default: all)")
        ->delimiter(',')
        ->check(CLI::IsMember(codec_names));
    verb.add_option("--fps", options.codec.corpus.frames_per_second,
                    "Samples a second, in whole pictures at one sample a pixel")
        ->check(CLI::Range(0.1, 1000.0))
        ->capture_default_str();
    verb.add_option("--charts", options.codec.charts, "Draw charts into this folder");
}

void add_layer_options(CLI::App& verb, VerbOptions& options) {
    add_output_options(verb, options);
    verb.add_option("--scene", options.layers.scenes, "Scene files to measure with (default: all of the project's)");
    verb.add_option("--pixels", options.layers.pixels, "How far off a sample may be shown")
        ->check(CLI::Range(0.01, 16.0))
        ->capture_default_str();
}

void add_antialiasing_options(CLI::App& verb, VerbOptions& options) {
    add_output_options(verb, options);
    verb.add_option("--scene", options.antialiasing.scenes,
                    "Scene files to measure with (default: all of the project's)");
}

void add_correspondence_options(CLI::App& verb, VerbOptions& options) {
    add_ahead_options(verb, options, options.correspondence, "globe, windmill, the vehicles");
}

void add_mirror_options(CLI::App& verb, VerbOptions& options) {
    add_ahead_options(verb, options, options.mirrors, "globe, stop, vehicle_chase, vehicle_flyby");
}

void add_smoothness_options(CLI::App& verb, VerbOptions& options) {
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

void add_stillness_options(CLI::App& verb, VerbOptions& options) {
    add_output_options(verb, options);
    add_size_option(verb, options);
    add_machine_options(verb, options);
    add_link_options(verb, options);
    verb.add_option("--scene", options.stillness.scenes, "Scene files to measure with (default: all of the project's)");
    verb.add_option("--seconds", options.seconds, "How long it is watched after the stop")
        ->check(CLI::Range(1.0, 600.0));
}

void add_wall_options(CLI::App& verb, VerbOptions& options) {
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

void add_response_options(CLI::App& verb, VerbOptions& options) {
    add_scene_options(verb, options);
    verb.add_option("--charts", options.study.charts, "Draw charts into this folder");
}

} // namespace framelet::bench
