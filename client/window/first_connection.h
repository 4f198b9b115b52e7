// The time before there is a server. In: the window, where the server will be. Out: a session, or that the user has
// given up; meanwhile the window says what is waited for, and why, and another server can be named.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "client/core/client_core.h"
#include "client/window/window.h"

namespace framelet {

struct FirstConnection {
    std::unique_ptr<ClientCore> core; ///< null: the user has quit
    ConnectionOptions options; ///< of the server that it is connected to
};

/// What it takes to connect to HOST[:PORT]. Throws InputError.
using OptionsFor = std::function<ConnectionOptions(std::string const& address)>;

/// Tries for as long as it takes, less often the longer, and at once when the user asks for it. A server that refuses
/// the viewer, for which trying again would not help, is tried once, and the user may name another. `recent`: servers
/// of before. Throws InputError as `options_for` does for the first address, and ServerConnection.
FirstConnection wait_for_server(Window& window, std::string const& address, OptionsFor const& options_for,
                                std::vector<std::string> const& recent);

} // namespace framelet
