// What framelet-client does once its options are read: looks at the scene, writes and counts what was shown.
#pragma once

#include <optional>

#include "client/frames/frame_writer.h"
#include "client/windowless/windowless_options.h"

namespace framelet {

/// Runs the client until its time is over, a signal ends it, the session has ended or nobody takes the frames any more,
/// and prints what it counted. `pattern`: the names of the pictures that are written, where they are. Throws InputError
/// where a file cannot be used, and ConnectionError where the server cannot be reached, has ended the session, or the
/// picture was not complete in time although that was asked for.
void run_windowless(WindowlessOptions const& options, ConnectionOptions const& connection, Viewport viewport,
                    std::optional<FramePattern> const& pattern);

} // namespace framelet
