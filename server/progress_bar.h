// Progress of loading on a terminal: one line that is redrawn; a line a stage where stderr is a file.
#pragma once

#include "server/scene/scene_import.h"

namespace framelet {

/// Prints to stderr. Nothing when `quiet`.
Progress make_progress_bar(bool quiet);

} // namespace framelet
