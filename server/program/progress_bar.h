// Shows the progress of loading: on a terminal one line that is redrawn, for a program lines of their own.
#pragma once

#include "server/scene/reading/progress.h"

namespace framelet {

/// Makes a progress that draws a line on stderr; nothing when `quiet` or where stderr is no terminal.
Progress make_progress_bar(bool quiet);

/// Makes one that prints to stdout a line "loading PERCENT% STAGE" for each percent, for who started this program.
Progress make_progress_lines(int descriptor);

} // namespace framelet
