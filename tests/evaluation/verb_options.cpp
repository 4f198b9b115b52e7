#include "tests/evaluation/verb_options.h"

#include <map>

#include <CLI/CLI.hpp>

#include "client/picture_size.h"
#include "common/command_line/number_range.h"
#include "common/error.h"
#include "tests/evaluation/ablation.h"
#include "tests/evaluation/method.h"

namespace framelet::bench {
namespace {

std::vector<std::string> const rival_part_names{"accumulation", "ahead", "spacing", "margin"};

Viewport read_size(std::string const& text) {
    bool const is_side = text.find_first_not_of("0123456789") == std::string::npos;
    try {
        return parse_size(is_side ? text + "x" + text : text);
    } catch (InputError const& error) {
        throw CLI::ValidationError("--size", error.what());
    }
}

void add_scene_options(CLI::App& verb, VerbOptions& options) {
    verb.add_option("--scenes,--scene", options.scenes, "Scene files, or names of bundled scenes")->delimiter(',');
    verb.add_option_function<std::string>(
        "--size", [&options](std::string const& text) { options.size = read_size(text); },
        "Size of the picture, WIDTHxHEIGHT or the side of a square, pixels");
    verb.add_option("--start", options.start, "Scene time from which on is measured (default: so that events are seen)")
        ->check(number_in(0.0, 1e6));
    verb.add_option("--seconds", options.seconds, "Scene time that is measured")->check(number_in(0.05, 600.0));
}

void add_reference_options(CLI::App& verb, VerbOptions& options) {
    auto& study = options.study;
    verb.add_option("--rate", options.rate, "Measurements a second")->check(number_in(1.0, 1000.0));
    verb.add_option("--reference-samples", study.samples_per_side, "Samples along a side of a reference's pixel")
        ->check(CLI::Range(1, 16))
        ->capture_default_str();
    verb.add_option("--reference-cache", study.reference_cache, "Folder that keeps references")->capture_default_str();
}

void add_method_options(CLI::App& verb, VerbOptions& options) {
    auto& run = options.study.run;
    verb.add_option("--methods", options.study.methods, "Which methods")
        ->delimiter(',')
        ->check(CLI::IsMember(method_names()));
    verb.add_option("--bias", run.bias, "The viewer's wish: -1 (spatial fidelity) .. 1 (temporal)")
        ->check(number_in(-1.0, 1.0))
        ->capture_default_str();
    verb.add_option("--rivals-without", options.rivals_without,
                    "What the rivals do not do, of accumulation, ahead, spacing and margin")
        ->delimiter(',')
        ->check(CLI::IsMember(rival_part_names));
    verb.add_option("--seed", run.seed, "Of everything that is random")->capture_default_str();
}

void add_machine_options(CLI::App& verb, VerbOptions& options) {
    verb.add_option("--machine", options.study.run.frames_per_second,
                    "The server: samples a displayed pixel and second that it renders and encodes")
        ->check(number_in(0.5, 60.0))
        ->capture_default_str();
    verb.add_flag("--total", options.total, "The viewer's work is charged to the server's processors");
    add_link_options(verb, options.megabits, options.delay_ms);
}

void add_turn_option(CLI::App& verb, VerbOptions& options) {
    verb.add_option("--turn", options.study.turn, "The camera turns back and forth, degrees a second")
        ->check(number_in(0.0, 3600.0));
}

} // namespace

void add_link_options(CLI::App& verb, double& megabits, double& delay_ms) {
    verb.add_option("--bandwidth", megabits, "The link's rate, Mbit/s; 0: unlimited")
        ->check(number_in(0.0, 1e6))
        ->capture_default_str();
    verb.add_option("--delay", delay_ms, "The link's delay each way, ms")
        ->check(number_in(0.0, 10000.0))
        ->capture_default_str();
}

std::vector<std::filesystem::path> bundled_scenes() {
    return files_in(source_folder / "scenes", ".glb");
}

std::vector<std::filesystem::path> files_in(std::filesystem::path const& folder, char const* extension) {
    std::vector<std::filesystem::path> files;
    for (auto const& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() == extension) {
            files.push_back(entry.path());
        }
    }
    std::ranges::sort(files);
    return files;
}

std::filesystem::path scene_file(std::string const& file_or_name) {
    auto const bundled = source_folder / "scenes" / (file_or_name + ".glb");
    bool const is_name = !std::filesystem::exists(file_or_name) && std::filesystem::exists(bundled);
    return is_name ? bundled : std::filesystem::path(file_or_name);
}

void settle(VerbOptions& options, Scale const& scale, std::vector<std::string> const& scenes) {
    auto& study = options.study;
    for (std::string const& part : options.rivals_without) {
        RivalParts& rivals = study.run.rivals;
        rivals.accumulate &= part != "accumulation";
        rivals.ahead &= part != "ahead";
        rivals.spacing = part == "spacing" ? 1 : rivals.spacing;
        rivals.margin = part == "margin" ? 0 : rivals.margin;
    }
    std::ranges::transform(options.scenes.empty() ? scenes : options.scenes, std::back_inserter(study.scenes),
                           scene_file);
    if (study.scenes.empty()) {
        study.scenes = bundled_scenes();
    }
    study.run.viewport = options.size.value_or(scale.viewport);
    study.run.start = options.start.value_or(0);
    study.sees_events = !options.start;
    study.run.seconds = options.seconds.value_or(scale.seconds);
    study.run.reference_rate = options.rate.value_or(scale.rate);
    if (options.link_file.empty()) {
        study.run.link.bits_per_second = 1e6 * options.megabits;
        study.run.link.delay_seconds = 1e-3 * options.delay_ms;
    } else {
        study.run.link = read_link(options.link_file);
    }
    study.run.link.seed = study.run.seed;
    study.run.counting = options.total ? Counting::total : Counting::server;
    study.costs = read_cost_table(options.costs_file);
}

void add_study_options(CLI::App& verb, VerbOptions& options) {
    verb.add_option("--json", options.json_file, "Write the figures to this file as well");
    verb.add_flag("--quick", options.quick, "Smaller pictures, less time");
    verb.add_option("--charts", options.study.charts, "Draw charts into this folder (compare, pauses)");
    verb.add_option("--costs", options.costs_file, "Table of stage costs (calibrate writes one)")
        ->capture_default_str();
    add_scene_options(verb, options);
    add_reference_options(verb, options);
    add_method_options(verb, options);
    add_machine_options(verb, options);
}

void add_table_options(CLI::App& verb, VerbOptions& options) {
    verb.add_option("--runs", options.table_runs, "Which runs of the table, by number (default: all)")
        ->delimiter(',')
        ->check(CLI::Range(0, 15));
}

void add_compare_options(CLI::App& verb, VerbOptions& options) {
    add_turn_option(verb, options);
    verb.add_option("--events", options.study.events,
                    "Events are announced by the scene's tracks, come by setting the clock (set), or from tracks that "
                    "are baked")
        ->transform(CLI::CheckedTransformer(std::map<std::string, Events>{
            {"announced", Events::announced}, {"set", Events::set}, {"baked", Events::baked}}));
    verb.add_option("--camera", options.study.camera, "Camera file: the viewer flies along it, by scene time")
        ->check(CLI::ExistingFile);
    verb.add_option("--orthographic", options.study.orthographic_height,
                    "The camera is orthographic; height of its picture, metres")
        ->check(number_in(0.0, 1e6));
    verb.add_option("--link", options.link_file, "A link from a file, in place of --bandwidth and --delay")
        ->check(CLI::ExistingFile);
    verb.add_option("--round-trip", options.round_trips, "Times of a round trip, ms, each compared in turn")
        ->delimiter(',')
        ->check(number_in(0.0, 20000.0));
}

void add_ablation_options(CLI::App& verb, VerbOptions& options) {
    add_turn_option(verb, options);
    verb.add_option("--without", options.without, "Which parts are left out in turn (default: each)")
        ->delimiter(',')
        ->check(CLI::IsMember(ablation_parts()));
}

void add_gate_options(CLI::App& verb, VerbOptions& options) {
    verb.add_option("--figures", options.gate_file, "The committed figures")->capture_default_str();
    verb.add_flag("--write", options.write_gate, "Write the figures anew");
}

void add_limits_options(CLI::App& verb, VerbOptions& options) {
    verb.add_option("--threads", options.threads,
                    "What each stage takes with so many threads instead, and what more come to: two numbers or more")
        ->delimiter(',')
        ->expected(2, 64)
        ->check(CLI::Range(1, 1024));
}

void add_reference_picture_options(CLI::App& verb, VerbOptions& options) {
    ReferencePictureOptions& picture = options.reference_picture;
    verb.add_option("--output", picture.output, "Picture as viewers show it (.png), or radiance (.exr)")
        ->capture_default_str();
    verb.add_option("--camera", picture.camera, "Camera file, as framelet-client takes it")->check(CLI::ExistingFile);
    verb.add_option("--environment", picture.environment, "Map that lights the scene")->check(CLI::ExistingFile);
    verb.add_option("--paths", picture.paths.paths, "Paths of each pixel")
        ->check(CLI::Range(1, 1 << 24))
        ->capture_default_str();
    verb.add_option("--sun-size", picture.sun_degrees, "Diameter of suns, degrees; 0: hard shadows")
        ->check(number_in(0.0, 90.0))
        ->capture_default_str();
    verb.add_option("--lamp-size", picture.lamp_metres, "Diameter of point and spot lights, metres; 0: hard shadows")
        ->check(number_in(0.0, 1e6))
        ->capture_default_str();
    CLI::Option* const direct = verb.add_flag("--direct", picture.direct, "As the server shades it, without paths");
    CLI::Option* const full =
        verb.add_flag("--full", picture.full, "With light of the light cache, and how far it is off the paths")
            ->excludes(direct);
    CLI::Option* const moved =
        verb.add_option("--moved", picture.moved_seconds, "With --full: the scene has moved for so long, seconds")
            ->needs(full)
            ->check(number_in(0.0, 60.0));
    verb.add_option("--gathered", picture.gathered_per_second, "With --moved: paths that are gathered in each second")
        ->needs(moved)
        ->check(number_in(0.0, 1e9))
        ->capture_default_str();
}

void add_report_options(CLI::App& verb, VerbOptions& options) {
    ReportOptions& report = options.report;
    verb.add_option("--folder", report.folder, "Keeps each run's figures: what is there is not run again")
        ->capture_default_str();
    verb.add_option("--documents", report.documents, "Folder for RESULTS.md and pictures/")->capture_default_str();
    verb.add_option("--assets", options.assets,
                    "Folder of models: the real programs also fly through those that tests/evaluation/flights names");
    verb.add_flag("--no-live", options.without_live, "No runs of the real programs");
}

} // namespace framelet::bench
