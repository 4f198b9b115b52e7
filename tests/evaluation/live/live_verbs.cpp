#include "tests/evaluation/live/live_verbs.h"

#include <cstdio>
#include <iostream>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "client/picture_size.h"
#include "common/command_line/number_range.h"
#include "common/error.h"
#include "server/scene/scene_import.h"
#include "tests/evaluation/codecs/link_emulator.h"
#include "tests/evaluation/method.h"
#include "tests/evaluation/verb_options.h"
#include "tests/loopback/replay.h"

namespace framelet::bench {

using nlohmann::json;

namespace {

void add_rival_options(CLI::App& verb, RivalParts& rivals) {
    rivals.spacing = 1;
    rivals.margin = 0;
    verb.add_option("--spacing", rivals.spacing, "Pixels from sample to sample of whole frames")
        ->check(number_in(0.01, 1000.0));
    verb.add_option("--margin", rivals.margin, "Around the viewport, of its sides")->check(number_in(0.0, 10.0));
}

LinkParameters link_of(LiveVerbOptions const& options) {
    return {.bits_per_second = 1e6 * options.megabits, .delay_seconds = 1e-3 * options.delay_ms};
}

} // namespace

void add_live_options(CLI::App& verb, LiveVerbOptions& options) {
    verb.add_option("--scenes,--scene", options.scenes, "Scene files (default: all bundled ones)");
    verb.add_option("--camera", options.live.camera_file, "Camera file to fly by, as framelet-client takes it");
    verb.add_option("--size", options.size, "Size of the picture, WIDTHxHEIGHT")->capture_default_str();
    verb.add_option("--seconds", options.live.seconds, "How long each method runs")
        ->check(number_in(1.5, 3600.0))
        ->capture_default_str();
    verb.add_option("--methods", options.live.methods, "Which methods")
        ->delimiter(',')
        ->check(CLI::IsMember(method_names()))
        ->capture_default_str();
    add_link_options(verb, options.megabits, options.delay_ms);
    verb.add_flag("--pinned", options.live.pinned, "Server and viewer on a core each");
    verb.add_option("--moments", options.live.moments, "Moments at which pictures are compared")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    verb.add_option("--runs", options.live.runs, "Runs of each method; figures are those of the median error")
        ->check(CLI::Range(1, 99))
        ->capture_default_str();
    verb.add_option("--reference-samples", options.live.samples_per_side, "Along a side of a reference's pixel")
        ->check(CLI::IsMember({1, 2, 4, 8}))
        ->capture_default_str();
    verb.add_option("--light", options.live.light, "Of all methods; of `full` the reference is made by paths")
        ->check(CLI::IsMember({"direct", "full"}))
        ->capture_default_str();
    verb.add_option("--reference-paths", options.live.paths, "Of a pixel of such a reference")
        ->check(CLI::Range(1, 1 << 16))
        ->capture_default_str();
    verb.add_flag("--virtual", options.live.predicts,
                  "Also what the virtual clock says of framelet's methods; needs --pinned");
    CLI::Option* const viewers =
        verb.add_option("--viewers", options.crowd.viewers, "So many viewers at once of framelet alone; no errors")
            ->check(CLI::Range(1, 1000));
    verb.add_flag("--stalled", options.crowd.stalled, "The same once more beside a viewer that reads nothing")
        ->needs(viewers);
    verb.add_option("--charts", options.live.charts, "Write what was shown beside its reference into this folder");
}

void add_serve_options(CLI::App& verb, LiveVerbOptions& options) {
    verb.add_option("METHOD", options.serve.method)->required()->check(CLI::IsMember(method_names()));
    verb.add_option("SCENE", options.serve.scene)->required();
    verb.add_option("--exposure", options.serve.exposure_ev, "Stops")->check(number_in(-32.0, 32.0));
    verb.add_option("--threads", options.serve.threads, "0: one a core");
    verb.add_option("--light", options.serve.light, "As framelet-server takes it");
    add_rival_options(verb, options.serve.rivals);
}

void add_look_options(CLI::App& verb, LiveVerbOptions& options) {
    LookOptions& look = options.look;
    verb.add_option("METHOD", look.method)->required()->check(CLI::IsMember(method_names()));
    verb.add_option("SCENE", look.scene)->required();
    verb.add_option("SERVER", options.server, "HOST:PORT")->required();
    verb.add_option("--size", options.size, "Size of the picture, WIDTHxHEIGHT")->capture_default_str();
    verb.add_option("--duration", look.duration, "Seconds")->check(number_in(0.0, 1e6));
    verb.add_option("--rate", look.rate, "Display frames a second")->check(number_in(0.1, 1000.0));
    verb.add_option("--camera", look.camera_file, "Camera file");
    add_rival_options(verb, look.rivals);
    verb.add_option("--output", look.output, "Picture files")->required();
    verb.add_option("--output-times", look.output_times, "Only the frames from these times of the scene on, seconds")
        ->check(number_in(0.0, 1e6));
    verb.add_option("--frames", look.frames_file, "A line of JSON for each frame")->required();
}

void add_replay_options(CLI::App& verb, LiveVerbOptions& options) {
    verb.add_option("RECORDING", options.recording, "What framelet-server --record-events wrote")->required();
}

void add_scale_options(CLI::App& verb, LiveVerbOptions& options) {
    ScaleOptions& scale = options.scale;
    verb.add_option("--scene", scale.scene, "Scene file (default: dusk)");
    verb.add_option("--size", options.scale_size, "Size of the picture, WIDTHxHEIGHT")->capture_default_str();
    verb.add_option("--seconds", scale.seconds, "Of each run")->check(number_in(1.0, 3600.0))->capture_default_str();
    verb.add_option("--workers", scale.workers, "How many, run by run; the first is compared with")
        ->delimiter(',')
        ->check(CLI::Range(0, 256))
        ->capture_default_str();
    verb.add_option("--charts", scale.charts, "Draw what a cluster comes to into this folder");
}

void add_soak_options(CLI::App& verb, LiveVerbOptions& options) {
    SoakOptions& soak = options.soak;
    verb.add_option("--scenes,--scene", options.scenes, "Scene files, which share the time (default: vehicle_chase)");
    verb.add_option("--seconds", soak.seconds, "How long all of it takes")
        ->check(number_in(1.0, 1e6))
        ->capture_default_str();
    verb.add_option("--viewers", soak.viewers, "Viewers that stay")->check(CLI::Range(1, 100))->capture_default_str();
    verb.add_option("--storm", soak.storm_seconds, "How long each storm takes, seconds")
        ->check(number_in(0.1, 3600.0))
        ->capture_default_str();
    verb.add_option("--events", soak.events, "What happens in storms, as a multiple of the usual; 0: viewers only fly")
        ->check(number_in(0.0, 100.0))
        ->capture_default_str();
    verb.add_option("--camera", options.live.camera_file, "Camera file to fly by, there and back, in storms");
    verb.add_option("--size", options.soak_size, "Size of pictures until an event resizes them, WIDTHxHEIGHT")
        ->capture_default_str();
    verb.add_option("--seed", soak.seed, "Of what happens when")->capture_default_str();
}

void add_link_verb_options(CLI::App& verb, LiveVerbOptions& options) {
    verb.add_option("PORT", options.link_to, "The server's, on this machine")->required()->check(CLI::Range(1, 65535));
    add_link_options(verb, options.megabits, options.delay_ms);
}

json answer_live(LiveVerbOptions& options, std::vector<std::filesystem::path> const& bundled,
                 std::filesystem::path const& costs_file) {
    LiveOptions& live = options.live;
    if (live.predicts && (!live.pinned || !live.camera_file.empty())) {
        throw InputError(
            "--virtual is of a server and a viewer with a core each (--pinned) and of the scene's own camera");
    }
    live.costs = read_cost_table(costs_file);
    live.viewport = parse_size(options.size);
    live.link = link_of(options);
    json runs = json::array();
    options.crowd.viewport = live.viewport;
    options.crowd.seconds = live.seconds;
    for (std::filesystem::path const& file : options.scenes.empty() ? bundled : options.scenes) {
        if (options.crowd.viewers > 0) {
            runs.push_back(measure_crowd(*load_bench_scene(file), options.crowd));
            continue;
        }
        runs.push_back(measure_live(*load_live_scene(file, live.light), live));
    }
    return runs;
}

json answer_serve(LiveVerbOptions& options, std::filesystem::path const& costs_file) {
    options.serve.costs = read_cost_table(costs_file);
    serve_method(options.serve);
    return {};
}

json answer_look(LiveVerbOptions& options, std::filesystem::path const& costs_file) {
    options.look.costs = read_cost_table(costs_file);
    options.look.viewport = parse_size(options.size);
    options.look.connection.server = parse_server_address(options.server);
    look_at_method(options.look);
    return {};
}

json answer_replay(LiveVerbOptions& options) {
    EventLogReader log(options.recording);
    ServedScene const& served = log.served();
    Scene const scene = import_scenes(std::vector<std::filesystem::path>(served.scenes.begin(), served.scenes.end()));
    std::optional<Environment> environment;
    if (!served.environment.empty()) {
        environment = Environment::load(served.environment);
    }
    RenderScene render_scene(scene, std::move(environment));
    render_scene.set_display({served.exposure, served.tone_curve});
    PosedScene posed(scene, served.clips, render_scene, served.light);
    ReplayFigures const figures = replay(log, posed);
    std::printf("%s: %.1f s, %llu turns, %llu batches, %llu bytes: ", scene.name.c_str(), figures.seconds,
                static_cast<unsigned long long>(figures.turns), static_cast<unsigned long long>(figures.batches),
                static_cast<unsigned long long>(figures.bytes));
    if (!figures.is_identical()) {
        std::printf("differs\n");
        throw InputError(figures.other_steps > 0 ? "turn " + std::to_string(figures.turns) + " was answered otherwise"
                                                 : std::to_string(figures.other_batches) +
                                                       " batches have other bytes, the first is batch " +
                                                       std::to_string(figures.first_other));
    }
    std::printf("byte-identical\n");
    return {{"scenes", served.scenes}, {"turns", figures.turns},     {"batches", figures.batches},
            {"bytes", figures.bytes},  {"seconds", figures.seconds}, {"identical", true}};
}

json answer_soak(LiveVerbOptions& options, std::filesystem::path const& usual) {
    std::vector<std::filesystem::path> scenes = options.scenes;
    if (scenes.empty()) {
        scenes.push_back(usual);
    }
    SoakOptions soak = options.soak;
    soak.seconds /= static_cast<double>(scenes.size());
    soak.viewport = parse_size(options.soak_size);
    if (!options.live.camera_file.empty()) {
        soak.flight = read_camera_path(options.live.camera_file);
        if (!(soak.flight->duration() > 0)) {
            throw InputError(options.live.camera_file.string() + ": there is nothing to fly by in it: it has one key");
        }
    }
    json runs = json::array();
    for (std::filesystem::path const& file : scenes) {
        runs.push_back(run_soak(*load_bench_scene(file), soak));
    }
    return runs;
}

json answer_scale(LiveVerbOptions& options, std::filesystem::path const& usual,
                  std::filesystem::path const& costs_file) {
    if (options.scale.scene.empty()) {
        options.scale.scene = usual;
    }
    options.scale.viewport = parse_size(options.scale_size);
    options.scale.costs = read_cost_table(costs_file);
    return measure_scale(options.scale);
}

json answer_link(LiveVerbOptions& options) {
    LinkEmulator const link(options.link_to, link_of(options));
    std::cout << "listening on 127.0.0.1:" << link.port() << std::endl;
    for (std::string line; std::getline(std::cin, line);) {
    }
    return {};
}

} // namespace framelet::bench
