// What stands for a server's connection in a web page: sockets and threads are the browser's, so that the page opens
// the session and then hands over what comes. In: the Welcome, later messages. Out: frames to send.
#pragma once

#include <functional>

#include "protocol/connection/server_connection.h"

namespace framelet {

/// The page's end of a connection. It outlives the ServerConnection that is made with it.
struct PageConnection {
    Welcome welcome; ///< of the session that the page has opened
    std::function<void(Bytes frame)> send; ///< hands a frame to the socket
    bool is_open = true; ///< a session is open: what is sent goes somewhere
    bool all_sent = true; ///< the socket has taken all that was sent
    ServerConnection::Handlers handlers{}; ///< set by ServerConnection; for the page to call
};

/// The options that a ServerConnection of the page is made with, and no other.
struct PageConnectionOptions : ConnectionOptions {
    PageConnection* page = nullptr;
};

} // namespace framelet
