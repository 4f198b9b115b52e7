// framelet-viewer: a window on a scene that framelet-server renders.
#include <iostream>
#include <optional>
#include <utility>
#include <vector>

#include "client/connection_arguments.h"
#include "client/display_arguments.h"
#include "client/gpu/canvas_choice.h"
#include "client/painter.h"
#include "client/picture_size.h"
#include "client/window/first_connection.h"
#include "client/window/kept/viewer_memory.h"
#include "client/window/scene_opener.h"
#include "client/window/viewer.h"
#include "common/command_line/program_failure.h"
#include "common/error.h"

namespace {

framelet::ProgramNotes notes() {
    return {
        "Where the server is not there yet the window waits for it. Where it is gone for a while, what is held goes on "
        "being shown, and the session goes on when it is back; see --no-reconnect. A scene file that is dropped on the "
        "window opens there, served by this machine.",
        {{0, "fine"},
         {1, "no display, a file cannot be used, or the server cannot be reached, refused the viewer or has vanished"},
         {2, "bad usage"}},
        {"framelet", "framelet-server", "framelet-client"}};
}

} // namespace

int main(int argc, char** argv) {
    using namespace framelet;
    ConnectionArguments arguments;
    arguments.server = ServerAddress{}.text();
    std::string size = "1280x720";
    bool fullscreen = false;
    std::string painter = "auto";
    DisplayArguments display;
    std::optional<int> server_needed;
    std::vector<std::string> server_options;

    CLI::App app("Shows a scene that framelet-server renders. F1 in the window lists the keys.", "framelet-viewer");
    prepare_command_line(app, notes());
    add_connection_options(app, arguments)->capture_default_str();
    app.option_defaults()->group("Window");
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
    // framelet gives this to the viewer that it starts: a descriptor for SceneOpener.
    app.add_option("--server-needed", server_needed)->group("")->configurable(false);
    app.add_option("--server-option", server_options) // for the servers of scenes that are dropped
        ->group("")
        ->configurable(false)
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    add_config_option(app);

    Viewport viewport;
    // A token belongs to one server: it is looked for anew for each that is named.
    OptionsFor const options_for = [&arguments](std::string const& address) {
        ConnectionArguments named = arguments;
        named.server = address;
        ConnectionOptions options = make_connection_options(named);
        options.token = read_token(named);
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
        ConnectionOptions const options = options_for(arguments.server);
        ViewerMemory memory = read_viewer_memory();
        if (sized->empty()) {
            viewport = memory.size.value_or(viewport);
        }
        Window window("framelet-viewer", viewport);
        SceneOpener opener(Viewer::connect, Window::wake, server_needed, server_options);
        Connection first;
        if (!options.reconnect) {
            first = {Viewer::connect(options), options};
        }
        window.show();
        if (fullscreen || (memory.fullscreen && sized->empty())) {
            window.toggle_fullscreen();
        }
        if (!first.core) {
            first = wait_for_server(window, arguments.server, options_for, memory.servers, opener);
        }
        if (!first.core) {
            return 1;
        }
        CanvasChoice choice = choose_canvas(parse_painter(painter));
        if (!choice.complaint.empty()) {
            std::cerr << "framelet-viewer: " << choice.complaint << std::endl;
        }
        int const result = Viewer(window, std::move(first), opener, display.settings(), display.lag_seconds(), memory,
                                  std::move(choice))
                               .run();
        write_viewer_memory(memory);
        return result;
    } catch (std::exception const& error) {
        std::cerr << "framelet-viewer: " << failure_text(error) << "\n";
        return 1;
    }
}
