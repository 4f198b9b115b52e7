// Runs a private server for a scene and a window on it, from the start of the one to the end of both.
#pragma once

#include "client/launcher/options.h"

namespace framelet {

/// Shows the scene until the window is closed or a signal ends it. Returns the exit code. Throws InputError where there
/// is no display or a program is missing.
int view(ViewOptions const& options);

} // namespace framelet
