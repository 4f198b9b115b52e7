// Waits for a server when the window is opened. In: the window, where the server will be. Out: a session, or that the
// user has given up; meanwhile the window says what is waited for, and why, and another server can be named or a scene
// dropped.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "client/window/connection.h"
#include "client/window/scene_opener.h"
#include "client/window/window.h"

namespace framelet {

/// Makes what it takes to connect to HOST[:PORT]. Throws InputError.
using OptionsFor = std::function<ConnectionOptions(std::string const& address)>;

/// Tries for as long as it takes, less often the longer, and at once when the user asks for it. A server that refuses
/// the viewer, for which trying again would not help, is tried once, and the user may name another, or drop a scene.
/// `recent`: servers of before. Throws InputError as `options_for` does for the first address, and ServerConnection.
Connection wait_for_server(Window& window, std::string const& address, OptionsFor const& options_for,
                           std::vector<std::string> const& recent, SceneOpener& opener);

} // namespace framelet
