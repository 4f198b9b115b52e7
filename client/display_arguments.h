// The part of the command line that both programs share: how the scene is to look.
#pragma once

#include "client/display_choice.h"
#include "common/command_line/command_line.h"

namespace framelet {

/// Adds --exposure, --no-reprojection, --smooth and --overlay. `choice` must outlive the parsing.
void add_display_options(CLI::App& app, DisplayChoice& choice);

} // namespace framelet
