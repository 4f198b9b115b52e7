// The command line of framelet, as a value.
#pragma once

#include <string>
#include <variant>
#include <vector>

namespace framelet {

/// Arguments with which the two programs are to be started.
struct ViewOptions {
    std::vector<std::string> scenes;
    std::vector<std::string> server; ///< all but the port and the scenes
    std::vector<std::string> other_scenes; ///< those of `server` that count for scenes that are dropped, too
    std::vector<std::string> viewer; ///< all but the server's address
};

/// The options, or the exit code where there is nothing to run (help, version: 0; bad usage: 2, with one line on
/// stderr).
std::variant<ViewOptions, int> parse_options(int argc, char const* const* argv);

} // namespace framelet
