// framelet-client: looks at a served scene without a window, writes what a person would have seen and what it measured.
#include <optional>

#include "client/picture_size.h"
#include "client/windowless/windowless_run.h"
#include "common/command_line/program_failure.h"
#include "common/command_line/standard_files.h"
#include "common/error.h"
#include "common/large_blocks.h"
#include "common/program_line.h"

// NOLINTNEXTLINE(bugprone-exception-escape): what nobody expects may end the program.
int main(int argc, char** argv) {
    using namespace framelet;
    open_standard_files();
    give_back_large_blocks();
    WindowlessOptions options;
    CLI::App app("Looks at a scene that framelet-server renders, without a window: writes pictures and statistics.",
                 "framelet-client");
    add_windowless_options(app, options);

    Viewport viewport;
    ConnectionOptions connection;
    std::optional<FramePattern> pattern;
    try {
        parse_command_line(app, argc, argv);
        viewport = parse_size(options.size);
        connection = make_connection_options(options.connection);
        check_output_options(options);
        if (!is_video(options) && !options.output.empty()) {
            pattern.emplace(options.output);
        }
    } catch (CLI::ParseError const& error) {
        return exit_usage(app, error);
    } catch (InputError const& error) {
        return exit_usage(app, error.what());
    }
    try {
        connection.token = read_token(options.connection);
        run_windowless(options, connection, viewport, pattern);
        return 0;
    } catch (std::exception const& error) {
        print_line("framelet-client", failure_text(error));
        return 1;
    }
}
