// framelet-viewer: a window on a scene that framelet-server renders.
#include <iostream>
#include <memory>
#include <utility>

#include "client/connection_arguments.h"
#include "client/display_arguments.h"
#include "client/picture_size.h"
#include "client/window/first_connection.h"
#include "client/window/viewer.h"
#include "common/error.h"
#include "common/program_failure.h"

namespace {

framelet::ProgramNotes notes() {
    return {
        "Where the server is not there yet the window waits for it. Where it is gone for a while, what is held goes on "
        "being shown, and the session goes on when it is back; see --no-reconnect.",
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
    DisplayArguments display;

    CLI::App app("Shows a scene that framelet-server renders. F1 in the window lists the keys.", "framelet-viewer");
    prepare_command_line(app, notes());
    add_connection_options(app, arguments)->capture_default_str();
    app.option_defaults()->group("Window");
    app.add_option("--size", size, "Size of the window in pixels")
        ->type_name("WIDTHxHEIGHT")
        ->check(readable_by(parse_size))
        ->capture_default_str();
    app.add_flag("--fullscreen", fullscreen, "Fill the screen");
    add_display_options(app, display);
    add_config_option(app);

    Viewport viewport;
    ConnectionOptions connection;
    try {
        parse_command_line(app, argc, argv);
        viewport = parse_size(size);
        connection = make_connection_options(arguments);
    } catch (CLI::ParseError const& error) {
        return exit_usage(app, error);
    } catch (InputError const& error) {
        return exit_usage(app, error.what());
    }
    try {
        connection.token = read_token(arguments);
        Window window("framelet-viewer", viewport);
        std::unique_ptr<ClientCore> core = connection.reconnect ? nullptr : Viewer::connect(connection);
        window.show();
        if (fullscreen) {
            window.toggle_fullscreen();
        }
        core = core ? std::move(core) : wait_for_server(window, connection);
        if (!core) {
            return 1;
        }
        return Viewer(window, connection, std::move(core), display.settings(), display.lag_seconds()).run();
    } catch (std::exception const& error) {
        std::cerr << "framelet-viewer: " << failure_text(error) << "\n";
        return 1;
    }
}
