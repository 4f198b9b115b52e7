// A session, and what it took to open it.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "client/core/client_core.h"
#include "client/window/named_server.h"

namespace framelet {

/// The server that is proposed where none is known; its port is `default_port`.
inline constexpr char const* usual_server = "localhost:7070";

/// Makes what it takes to connect to a server. Throws InputError.
using OptionsFor = std::function<ConnectionOptions(NamedServer const& server)>;

struct Connection {
    std::unique_ptr<ClientCore> core; ///< null: the user has quit before there was one
    ConnectionOptions options;
};

} // namespace framelet
