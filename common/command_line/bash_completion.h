// Bash's completion of a program's command line, made from what its --help is made of.
#pragma once

#include <string>

#include <CLI/App.hpp>

namespace framelet {

/// A script for /usr/share/bash-completion/completions.
std::string bash_completion(CLI::App const& app);

} // namespace framelet
