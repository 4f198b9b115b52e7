// framelet: shows a scene on this machine, by the two programs that do it across a network.
#include <exception>

#include "client/launcher/options.h"
#include "client/processes/child.h"
#include "common/command_line/program_failure.h"
#include "common/program_line.h"

int main(int argc, char** argv) {
    auto const parsed = framelet::parse_options(argc, argv);
    if (int const* const exit_code = std::get_if<int>(&parsed)) {
        return *exit_code;
    }
    try { // the viewer starts the server, and shows how far that has loaded the scene
        auto const& call = std::get<framelet::ProgramCall>(parsed);
        framelet::become(framelet::find_program(call.program), call.arguments);
    } catch (std::exception const& error) {
        framelet::print_line("framelet", framelet::failure_text(error));
        return 1;
    }
}
