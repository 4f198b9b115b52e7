// Progress of loading on a terminal: one line that is redrawn.
#pragma once

#include "server/scene/reading/progress.h"

namespace framelet {

/// Prints to stderr. Nothing when `quiet` or where stderr is no terminal.
Progress make_progress_bar(bool quiet);

} // namespace framelet
