// framelet-bench: measures the renderer, one verb a question.
#include <fstream>
#include <iostream>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "common/error.h"
#include "tests/evaluation/limits.h"

namespace {

struct Options {
    std::string scene = FRAMELET_SOURCE_DIR "/scenes/vehicle_chase.glb";
    std::string json_file;
    bool quick = false;
};

void add_common_options(CLI::App& verb, Options& options) {
    verb.add_option("--scene", options.scene, "Scene file to measure with")->capture_default_str();
    verb.add_option("--json", options.json_file, "Write the figures to this file as well");
    verb.add_flag("--quick", options.quick, "Smaller pictures, fewer rounds");
}

void write_json(std::string const& file, nlohmann::json const& figures) {
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
    CLI::App& limits = *app.add_subcommand("limits", "Each stage against its bare limit");
    add_common_options(limits, options);
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
        auto const scene = framelet::bench::load_bench_scene(options.scene);
        framelet::bench::LimitsOptions limits_options;
        if (options.quick) {
            limits_options = {{640, 360}, 3};
        }
        nlohmann::json const figures = framelet::bench::measure_limits(*scene, limits_options);
        if (!options.json_file.empty()) {
            write_json(options.json_file, figures);
        }
        return 0;
    } catch (std::exception const& error) {
        std::cerr << "framelet-bench: " << error.what() << '\n';
        return 1;
    }
}
