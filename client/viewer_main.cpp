// framelet-viewer: a window on a scene that framelet-server renders.
#include <optional>
#include <utility>
#include <vector>

#include "client/connection_arguments.h"
#include "client/core/camera/camera_path.h"
#include "client/display_arguments.h"
#include "client/gpu/canvas_choice.h"
#include "client/painter.h"
#include "client/picture_size.h"
#include "client/processes/end_signals.h"
#include "client/window/attempts.h"
#include "client/window/kept/viewer_memory.h"
#include "client/window/scene_opener.h"
#include "client/window/start_panel.h"
#include "client/window/viewer.h"
#include "common/command_line/program_failure.h"
#include "common/command_line/standard_files.h"
#include "common/error.h"
#include "common/large_blocks.h"
#include "common/program_line.h"
#include "protocol/connection/unknown_certificate.h"
#include "protocol/stream/token.h"

namespace {

framelet::ProgramNotes notes() {
    return {
        "Without HOST the window asks for a server, and lists those of before. Where the server is not there yet the "
        "window waits for it. Where it is gone for a while, what is held goes on being shown, and the session goes on "
        "when it is back; see --no-reconnect. A scene file that is dropped on the window opens there, served by this "
        "machine, as does that of --open. SIGINT (Ctrl-C), SIGTERM and SIGHUP end the viewer as closing its window "
        "does, with a film that is being recorded complete.",
        {{0, "fine: the window was closed, or a signal ended it"},
         {1, "no display, a file cannot be used, or the server of the command line refused the viewer, cannot be "
             "reached with --no-reconnect, or was gone when the window was closed"},
         {2, "bad usage"}},
        {"framelet", "framelet-server", "framelet-client"}};
}

void remember(framelet::Window const& window, framelet::ViewerMemory& memory) {
    memory.size = window.windowed_size();
    memory.fullscreen = window.is_fullscreen();
    framelet::write_viewer_memory(memory);
}

} // namespace

// NOLINTNEXTLINE(bugprone-exception-escape): what nobody expects may end the program.
int main(int argc, char** argv) {
    using namespace framelet;
    open_standard_files();
    give_back_large_blocks();
    note_end_signals();
    ConnectionArguments arguments;
    arguments.server = usual_server;
    std::string size = "1280x720";
    std::string camera_file;
    bool fullscreen = false;
    std::string painter = "auto";
    DisplayChoice display;
    std::vector<std::string> scenes;
    bool needs_scene = false;
    std::vector<std::string> server_options;

    CLI::App app("Shows a scene that framelet-server renders. F1 in the window lists the keys.", "framelet-viewer");
    prepare_command_line(app, notes());
    CLI::Option const* const server = add_connection_options(app, arguments)->default_str("the window asks");
    app.option_defaults()->group("Window");
    app.add_option(
           "--open", scenes,
           "Open this scene file, served by this machine alone, instead of connecting to HOST; may be given several "
           "times: they are shown together")
        ->type_name("SCENE")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option(
           "--camera", camera_file,
           "Camera file (JSON) to begin with, as C in the window copies it; of a flight its beginning; or an address "
           "of the web page, of which its camera counts")
        ->type_name("FILE")
        ->default_str("the scene's own view");
    CLI::Option const* const sized =
        app.add_option("--size", size, "Size of the window in pixels; without it as it was last time")
            ->type_name("WIDTHxHEIGHT")
            ->check(readable_by(parse_size))
            ->capture_default_str();
    app.add_flag("--fullscreen", fullscreen, "Fill the screen, as it also does where it did last time");
    app.add_option("--painter", painter,
                   "What paints: the graphics card (gpu), the processor (cpu), or whichever is better (auto)")
        ->type_name("auto|cpu|gpu")
        ->check(readable_by(parse_painter))
        ->capture_default_str();
    add_display_options(app, display);
    // framelet becomes the viewer with these: without the scene there is nothing to look at, and the options of its
    // server.
    app.add_flag("--needs-scene", needs_scene)->group("")->configurable(false);
    app.add_option("--server-option", server_options)
        ->group("")
        ->configurable(false)
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    add_config_option(app);

    Viewport viewport;
    // A token belongs to one server: it is looked for anew for each that is named.
    OptionsFor const options_for = [&arguments](NamedServer const& named) {
        ConnectionArguments filled = arguments;
        filled.server = named.address;
        ConnectionOptions options = make_connection_options(filled);
        options.token = named.token.empty() ? read_token(filled) : token_in(named.token, "the token");
        return options;
    };
    try {
        parse_command_line(app, argc, argv);
        viewport = parse_size(size);
        make_connection_options(arguments);
    } catch (CLI::ParseError const& error) {
        return exit_usage(app, error);
    } catch (InputError const& error) {
        return exit_usage(app, error.what());
    }
    try {
        std::optional<CameraPath> camera;
        if (!camera_file.empty()) {
            camera = read_camera_path(camera_file);
            if (display.exposure_ev) {
                camera->moment.exposure_ev.reset();
            }
        }
        ConnectionOptions const options = options_for({arguments.server});
        ViewerMemory memory = read_viewer_memory();
        if (sized->empty()) {
            viewport = memory.size.value_or(viewport);
        }
        Window window("framelet-viewer", viewport);
        SceneOpener opener(connect_for_window, Window::wake, server_options);
        Start start{{}, needs_scene, memory.servers, arguments.tls || !arguments.authority_file.empty()};
        Connection first;
        if (!scenes.empty()) {
            opener.open_first(scenes, options);
        } else if (!server->empty()) {
            start.address = arguments.server;
            if (!options.reconnect) {
                try {
                    first = {connect_for_window(options), options};
                } catch (UnknownCertificate const&) { // the window asks
                }
            }
        }
        window.show();
        if (fullscreen || (memory.fullscreen && sized->empty())) {
            window.toggle_fullscreen();
        }
        if (!first.core) {
            first = run_start_panel(window, start, options_for, opener);
        }
        if (!first.core) {
            remember(window, memory);
            return needs_scene && !is_told_to_end() ? opener.exit_code() : 0;
        }
        CanvasChoice choice = choose_canvas(parse_painter(painter));
        if (!choice.complaint.empty()) {
            print_line("framelet-viewer", choice.complaint);
        }
        int const result =
            Viewer(window, std::move(first), options_for, opener, display, camera, memory, std::move(choice)).run();
        remember(window, memory);
        return result;
    } catch (std::exception const& error) {
        print_line("framelet-viewer", failure_text(error));
        return 1;
    }
}
