// The connection to a server with its own thread: resolves, connects, shakes hands, delivers messages, notices when the
// server is gone. In: where the server is. Out: Welcome, then messages; or one line that says why not.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "client/server_address.h"
#include "protocol/message.h"

namespace framelet {

class ServerConnection {
public:
    /// Called from the connection's thread. What `on_message` throws as ProtocolError ends the connection.
    struct Handlers {
        std::function<void(Message)> on_message;
        /// Once, when an open session ends for whatever reason but our own; one line.
        std::function<void(std::string reason)> on_lost;
        /// Something that was queued has been sent.
        std::function<void()> on_sent;
    };

    /// Blocks until the session is open. Throws ConnectionError where it cannot be opened, InputError for a certificate
    /// authority file that cannot be used.
    ServerConnection(ConnectionOptions const& options, Handlers handlers);
    /// Ends the session. No handler is called afterwards. Not to be called from a handler.
    ~ServerConnection();
    ServerConnection(ServerConnection const&) = delete;
    ServerConnection& operator=(ServerConnection const&) = delete;

    Welcome const& welcome() const;
    /// From any thread. Nothing happens once the connection has ended.
    void send(Message const& message);
    /// True when everything that was queued has been taken by the network. From any thread.
    bool all_sent() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace framelet
