// framelet-bench: measures the renderer, one verb a question.
#include <fstream>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "common/error.h"
#include "common/large_blocks.h"
#include "framelet_version.h"
#include "tests/evaluation/live/live_verbs.h"
#include "tests/evaluation/verbs.h"

namespace {

using namespace framelet::bench;
using nlohmann::json;
using Answer = std::function<json()>;

void write_json(std::string const& file, json const& figures) {
    std::ofstream stream(file);
    stream << figures.dump(2) << '\n';
    if (!stream.flush()) {
        throw framelet::InputError("cannot write '" + file + "'");
    }
}

/// Adds a verb to the command line; when it is chosen it puts its work into `answer`.
void add_verb(CLI::App& app, Verb const& verb, VerbOptions& options, Answer& answer) {
    CLI::App& command = *app.add_subcommand(verb.name, verb.question);
    add_study_options(command, options);
    if (verb.add_options != nullptr) {
        verb.add_options(command, options);
    }
    command.callback([&] {
        answer = [&] {
            settle(options, options.quick ? verb.quick : verb.usual, verb.scenes);
            return verb.answer(options);
        };
    });
}

void add_live_verbs(CLI::App& app, VerbOptions& options, LiveVerbOptions& live, Answer& answer) {
    auto const add = [&](char const* name, char const* question, auto add_options, Answer run) -> CLI::App& {
        CLI::App& command = *app.add_subcommand(name, question);
        command.add_option("--json", options.json_file, "Write the figures to this file as well");
        command.add_option("--costs", options.costs_file, "Table of stage costs")->capture_default_str();
        add_options(command, live);
        command.callback([&answer, run] { answer = run; });
        return command;
    };
    add("live", "The real programs as a person runs them, every method: pictures a second, errors, costs",
        add_live_options, [&] { return answer_live(live, bundled_scenes(), options.costs_file); });
    add("soak", "A server in bad weather for long: whether pictures stay exact, and nothing is lost (else exit code 1)",
        add_soak_options, [&] { return answer_soak(live, scene_file("vehicle_chase")); });
    add("scale", "What other processes buy that trace paths of light for a server, and what a cluster comes to",
        add_scale_options, [&] { return answer_scale(live, scene_file("dusk"), options.costs_file); });
    add("replay", "A recorded session through the same pipeline: whether the same bytes come out", add_replay_options,
        [&] { return answer_replay(live); });
    add("link", "A link of this rate and delay before a server, for viewers of any kind", add_link_verb_options,
        [&] { return answer_link(live); });
    add("serve", "Serves a method to `look`, for `live`", add_serve_options, [&] {
        return answer_serve(live, options.costs_file);
    }).group("");
    add("look", "Shows what `serve` serves, for `live`", add_look_options, [&] {
        return answer_look(live, options.costs_file);
    }).group("");
}

/// Number of failures in runs that list what has failed in them.
std::size_t failures_in(json const& runs) {
    std::size_t count = 0;
    for (json const& run : runs) {
        count += run.is_object() && run.contains("failures") ? run["failures"].size() : 0;
    }
    return count;
}

/// The command as it was typed, but for the folders of whoever typed it.
std::string command_of(std::vector<std::string> const& words) {
    std::string command = "framelet-bench";
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (words[i] == "--folder" || words[i] == "--documents" || words[i] == "--reference-cache") {
            ++i; // leave out its value as well
        } else if (words[i] == "--assets") {
            command += " --assets FOLDER";
            ++i;
        } else {
            command += " " + words[i];
        }
    }
    return command;
}

} // namespace

int main(int argc, char** argv) {
    framelet::give_back_large_blocks(); // as the programs do
    VerbOptions options;
    LiveVerbOptions live;
    Answer answer;
    CLI::App app("Measures framelet: each verb answers one question.", "framelet-bench");
    app.set_version_flag("--version", "framelet-bench " FRAMELET_VERSION);
    app.require_subcommand(1);
    add_live_verbs(app, options, live, answer);
    for (Verb const& verb : verbs()) {
        add_verb(app, verb, options, answer);
    }
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
    options.command = command_of({argv + 1, argv + argc});
    spdlog::set_level(spdlog::level::warn);
    try {
        json const figures = answer();
        if (!options.json_file.empty()) {
            write_json(options.json_file, figures);
        }
        if (std::size_t const failures = failures_in(figures); failures > 0) {
            std::cerr << "framelet-bench: " << failures << " failures, see above\n";
            return 1;
        }
        return 0;
    } catch (std::exception const& error) {
        std::cerr << "framelet-bench: " << error.what() << '\n';
        return 1;
    }
}
