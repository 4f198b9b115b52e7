// framelet-bench: measures the renderer, one verb a question.
#include <fstream>
#include <functional>
#include <iostream>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "common/error.h"
#include "tests/evaluation/live/live_verbs.h"
#include "tests/evaluation/sensitivity.h"
#include "tests/evaluation/verb_answers.h"
#include "tests/evaluation/verb_options.h"
#include "tests/evaluation/verbs.h"

namespace {

using nlohmann::json;

void write_json(std::string const& file, json const& figures) {
    std::ofstream stream(file);
    stream << figures.dump(2) << '\n';
    if (!stream.flush()) {
        throw framelet::InputError("cannot write '" + file + "'");
    }
}

} // namespace

int main(int argc, char** argv) {
    using namespace framelet::bench;
    VerbOptions options;
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
        add_estimator_options(verb, options.estimators);
        verb.callback([&, run] { answer = [&options, run] { return run(options.estimators); }; });
    };
    auto const with_scene = [&options](auto run) {
        return [&options, run] { return run(*load_bench_scene(options.scene, options.camera)); };
    };
    auto const study = [&options, &with_scene](auto run) {
        return with_scene([&options, run](BenchScene& scene) {
            settle(options, options.quick ? Scale{.size = 256, .seconds = 1} : Scale{});
            if (options.study.methods.empty()) {
                options.study.methods = method_names();
            }
            return run(scene, options.study);
        });
    };
    add_verb("compare", "Error over time and cost of every method, beside the reference", add_run_options,
             study(compare));
    add_verb("pareto", "Error against server CPU, bytes and delay", add_run_options, study(pareto));
    add_verb("link", "Error against the link's rate, delay and stalls", add_run_options, study(link_study));
    add_verb("turn", "Error and lag against the round trip while the camera turns", add_run_options,
             with_scene([&options](BenchScene& scene) { return answer_turn(scene, options); }));
    add_verb("links", "The project's error beside coded whole frames', for every scene on several links",
             add_link_table_options, [&options] { return answer_links(options); });
    add_verb("table", "Runs and scenes of the dissertation's Table 7.2 (--quick: those of 256x256)", add_table_options,
             [&options] { return answer_table(options); });
    add_verb("stability", "How the loop of error, density and tiling settles after events, and how steady it is then",
             add_stability_options, [&options] { return answer_stability(options); });
    add_verb("ablation", "What each part of framelet buys, and what it costs: error, bytes and work without it",
             add_ablation_options, [&options] { return answer_ablation(options); });
    add_verb("wall", "The real server and client through an emulated link, beside what the virtual clock predicts",
             add_wall_options, study([&options](BenchScene& scene, StudyOptions const& settled) {
                 return measure_wall(scene, settled, options.wall);
             }));
    add_verb("reference", "Renders what the methods are compared with", add_study_options, study(prepare_reference));
    add_verb("sensitivity", "How tsar answers to steeper and flatter templates of its error estimate", add_run_options,
             study(sensitivity));
    add_verb("antialiasing", "What regular and jittered samples give for the same number of them",
             add_antialiasing_options, [&options] { return answer_antialiasing(options); });
    add_verb("layers", "How many planes framelets are, how far off those show samples, and what finding them costs",
             add_layer_options, [&options] { return answer_layers(options); });
    add_verb("correspondence", "How far off the viewer shows what it moves", add_correspondence_options,
             [&options] { return answer_correspondence(options); });
    add_verb("mirrors", "What becomes of mirror reflections that the viewer moves", add_mirror_options,
             [&options] { return answer_mirrors(options); });
    add_verb("smoothness",
             "How steadily the scene moves where the viewer shows it a little late, and how far off that is",
             add_smoothness_options, [&options] { return answer_smoothness(options); });
    add_verb("stillness", "How good the picture gets once everything stands still, how soon, and what is sent then",
             add_stillness_options, [&options] { return answer_stillness(options); });
    add_verb("calibrate", "What every stage costs on this machine", add_scene_options,
             with_scene([&options](BenchScene& scene) { return answer_calibrate(scene, options); }));
    add_verb("codec", "Bytes of a sample against the error of what is decoded, for each way of coding framelets",
             add_codec_options, [&options] { return answer_codec(options); });
    add_verb("limits", "Each stage against its bare limit", add_scene_options,
             with_scene([&options](BenchScene& scene) { return answer_limits(scene, options); }));
    add_verb("response", "What response, tiling and selection cost for pictures of 256 to 4096 pixels",
             add_response_options,
             with_scene([&options](BenchScene& scene) { return answer_response(scene, options); }));
    LiveVerbOptions live;
    auto const add_live_verb = [&](char const* name, char const* question, auto add_options, auto run) -> CLI::App& {
        CLI::App& verb = *app.add_subcommand(name, question);
        verb.add_option("--json", options.json_file, "Write the figures to this file as well");
        verb.add_option("--costs", options.costs_file, "Table of stage costs")->capture_default_str();
        add_options(verb, live);
        verb.callback([&answer, run] { answer = run; });
        return verb;
    };
    add_live_verb("live", "The real programs as a person runs them, every method: pictures a second, errors, costs",
                  add_live_options, [&live] { return answer_live(live, bundled_scenes()); });
    add_live_verb("replay", "A recorded session through the same pipeline: whether the same bytes come out",
                  add_replay_options, [&live] { return answer_replay(live); });
    add_live_verb("serve", "Serves a method to `look`, for `live`", add_serve_options, [&] {
        return answer_serve(live, options.costs_file);
    }).group("");
    add_live_verb("look", "Shows what `serve` serves, for `live`", add_look_options, [&] {
        return answer_look(live, options.costs_file);
    }).group("");
    add_estimator_verb("estimators", "Cost of error estimators against their agreement with the ideal density",
                       compare_estimators);
    add_estimator_verb("fit", "Fits the templates of the error estimators", fit_estimators);
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
