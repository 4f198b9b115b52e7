#include "client/launcher/options.h"

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "client/painter.h"
#include "client/picture_size.h"
#include "common/command_line/command_line.h"
#include "common/command_line/option_text.h"

namespace framelet {
namespace {

constexpr char const* scene_group = "Scene, for framelet-server";
constexpr char const* window_group = "Window, for framelet-viewer";

ProgramNotes notes() {
    return {
        "What follows a -- is for framelet-server, as in framelet view scene.glb -- --exposure 1. All other options "
        "of both programs can be set in files: see --server-config and --viewer-config.\n\n"
        "The window shows how far the scene is loaded. The server listens on a free port of this machine and lets in "
        "viewers of the same user alone. framelet becomes framelet-viewer; the programs are looked for where framelet "
        "is, then in PATH. With --web it becomes framelet-server instead. They end with the window, and with SIGINT "
        "(Ctrl-C), SIGTERM or SIGHUP.",
        {{0, "fine: the window was closed, or a signal ended it"},
         {1, "no display, a program is missing, the scene or another file cannot be used, or the server was gone when "
             "the window was closed"},
         {2, "bad usage"}},
        {"framelet-server", "framelet-viewer", "framelet-client"}};
}

constexpr char const* for_server = "--server-option=";

/// Passes the options of a group on to another program as they were written, each behind `prefix`. `--server-config`
/// and the like stand for that program's `--config`.
void pass_on(CLI::App const& app, std::string const& group, std::string const& prefix, std::vector<std::string>& to) {
    for (CLI::Option const* const option : options_of_group(app, group)) {
        std::string const name = option->get_name().ends_with("-config") ? "--config" : option->get_name();
        for (std::string const& value : option->results()) {
            to.push_back(prefix + (option->get_items_expected_min() == 0 ? name : name + "=" + value));
        }
    }
}

} // namespace

std::variant<ProgramCall, int> parse_options(int argc, char const* const* argv) {
    std::vector<std::string> scenes;
    char const* const* const end = argv + argc;
    char const* const* const separator = std::find(argv, end, std::string("--"));

    CLI::App app("Shows a scene on this machine: server and window with one command.", "framelet");
    prepare_command_line(app, notes());
    app.require_subcommand(1);
    CLI::App* const view =
        app.add_subcommand("view", "Serve a scene, open a window on it, and end both when it is closed");
    view->get_help_ptr()->group(app.get_help_ptr()->get_group());
    // Their values are taken from CLI11 as they were written.
    auto const option = [&](char const* name, std::string const& text) { return view->add_option(name, text); };
    auto const flag = [&](char const* name, std::string const& text) { view->add_flag(name, text); };
    view->option_defaults()->group(scene_group);
    view->add_option(
            "SCENE", scenes,
            "Scene file: .gltf, .glb, .obj and what else framelet-server reads; several are shown together; of a "
            "folder the scene files in it and below are listed")
        ->required();
    option("--environment", "Environment map (.hdr, .exr) that lights the scene")->type_name("FILE");
    option("--clip", "Animation clip to play, by name; may be given several times")
        ->type_name("NAME")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    option("--scene", "Scene of a glTF file to show, by name or number from 0")->type_name("NAME|N");
    option("--up", "Axis that is up, of files that do not say so or say it wrongly")->type_name("x|y|z");
    option("--unit", "Unit of length, likewise: mm, cm, m, km, in or ft")->type_name("UNIT");
    flag("--allow-outside", "Read files that the scene names outside its own folder as well");
    flag("--watch", "Load the scene again when its files have changed");
    flag("--paused", "Start with the scene clock standing");
    option("--threads", "Threads to render with; 0: one a core")->type_name("NUMBER");
    option("--server-config", "Take further options of framelet-server from this file")->type_name("FILE");
    view->option_defaults()->group(window_group);
    option("--size", "Size of the window in pixels")->type_name("WIDTHxHEIGHT")->check(readable_by(parse_size));
    flag("--fullscreen", "Fill the screen");
    option("--camera", "Camera file (JSON) to begin with")->type_name("FILE");
    option("--painter", "What paints: the graphics card (gpu), the processor (cpu), or whichever is better (auto)")
        ->type_name("auto|cpu|gpu")
        ->check(readable_by(parse_painter));
    option("--viewer-config", "Take further options of framelet-viewer from this file")->type_name("FILE");
    view->option_defaults()->group("Browser");
    flag("--web", "Open the page that the server has for browsers instead of a window, until Ctrl-C");
    CLI::Option* const web = view->get_option("--web");
    for (CLI::Option const* const of_window : options_of_group(*view, window_group)) {
        web->excludes(view->get_option(of_window->get_name()));
    }
    try {
        parse_command_line(app, static_cast<int>(separator - argv), argv);
    } catch (CLI::ParseError const& error) {
        return exit_usage(app, error);
    }
    std::error_code unknown;
    if (scenes.size() == 1 && std::filesystem::is_directory(scenes.front(), unknown)) {
        return ProgramCall{"framelet-server", {"--list-as=framelet view", "--", scenes.front()}};
    }
    std::vector<std::string> out;
    if (web->count() > 0) {
        out = {"--browser", "--port=0"};
        pass_on(*view, scene_group, "", out);
        out.insert(out.end(), separator == end ? end : separator + 1, end);
        out.emplace_back("--");
        out.insert(out.end(), scenes.begin(), scenes.end());
        return ProgramCall{"framelet-server", out};
    }
    pass_on(*view, window_group, "", out);
    std::ranges::transform(scenes, std::back_inserter(out), [](std::string const& scene) { return "--open=" + scene; });
    out.emplace_back("--needs-scene");
    pass_on(*view, scene_group, for_server, out);
    std::transform(separator == end ? end : separator + 1, end, std::back_inserter(out),
                   [](char const* word) { return for_server + std::string(word); });
    return ProgramCall{"framelet-viewer", out};
}

} // namespace framelet
