// The command line of framelet, as that of framelet-viewer.
#pragma once

#include <string>
#include <variant>
#include <vector>

namespace framelet {

using ViewerArguments = std::vector<std::string>;

/// The arguments of the viewer, or the exit code where there is nothing to run (help, version: 0; bad usage: 2, with
/// one line on stderr).
std::variant<ViewerArguments, int> parse_options(int argc, char const* const* argv);

} // namespace framelet
