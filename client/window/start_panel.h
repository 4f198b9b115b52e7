// The window before there is a session. In: the window, and what the command line asks for. Out: a session, or that
// there is to be none; meanwhile the window says what is waited for, and why, or asks for a server. Another server can
// be named, and a scene dropped.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "client/window/connection.h"
#include "client/window/scene_opener.h"
#include "client/window/window.h"

namespace framelet {

/// What the window is to begin with.
struct Start {
    std::optional<std::string> address; ///< nothing: what `opener` opens, and where that is nothing the user is asked
    bool needs_scene = false; ///< it ends where `opener` cannot open a scene
    std::vector<std::string> recent; ///< servers of before
    bool always_tls = false; ///< the command line says so
};

/// Tries to reach a server for as long as it takes, less often the longer, and at once when the user asks for it. One
/// that refuses the viewer, for which trying again would not help, is tried once, and the user may name another, or
/// drop a scene. Throws InputError as `options_for` does for the first address, and ConnectionRefusal where that server
/// refuses. Returns no session where the user closed the window, a signal told the program to end, or `needs_scene`.
Connection run_start_panel(Window& window, Start const& start, OptionsFor const& options_for, SceneOpener& opener);

} // namespace framelet
