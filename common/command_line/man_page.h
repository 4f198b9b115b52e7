// A program's manual page, in roff, from what its --help is made of.
#pragma once

#include <string>

#include <CLI/App.hpp>

#include "common/command_line/program_notes.h"

namespace framelet {

/// The page, of section 1; the options of the program's commands are in it, too.
std::string man_page(CLI::App const& app, ProgramNotes const& notes);

} // namespace framelet
