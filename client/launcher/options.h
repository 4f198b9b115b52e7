// The command line of framelet, as that of the program that it becomes.
#pragma once

#include <string>
#include <variant>
#include <vector>

namespace framelet {

struct ProgramCall {
    std::string program; ///< its name
    std::vector<std::string> arguments;
};

/// The viewer with what it is to show or, for a folder, the server that lists its scenes; or the exit code where there
/// is nothing to run (help, version: 0; bad usage: 2, with one line on stderr).
std::variant<ProgramCall, int> parse_options(int argc, char const* const* argv);

} // namespace framelet
