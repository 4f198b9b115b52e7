// A server as the user names it in the window. A value.
#pragma once

#include <string>

namespace framelet {

struct NamedServer {
    std::string address; ///< as `parse_server_address` and `asks_for_tls` read it
    std::string token{}; ///< empty: what the command line says
};

} // namespace framelet
