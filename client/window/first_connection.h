// The time before there is a server. In: the window, where the server will be. Out: a session, or that the user has
// given up; meanwhile the window says what is waited for, and why.
#pragma once

#include <memory>

#include "client/core/client_core.h"
#include "client/window/window.h"

namespace framelet {

/// Tries for as long as it takes, less often the longer, and at once when the user asks for it. Null: the user has
/// quit. Throws ConnectionRefusal where trying again would not help, and InputError as ServerConnection does.
std::unique_ptr<ClientCore> wait_for_server(Window& window, ConnectionOptions const& connection);

} // namespace framelet
