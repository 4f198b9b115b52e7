// A session, and what it took to open it.
#pragma once

#include <memory>

#include "client/core/client_core.h"

namespace framelet {

struct Connection {
    std::unique_ptr<ClientCore> core; ///< null: the user has quit before there was one
    ConnectionOptions options;
};

} // namespace framelet
