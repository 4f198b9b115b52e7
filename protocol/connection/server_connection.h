// The connection to a server with its own thread: resolves, connects, shakes hands, delivers messages, notices when the
// server is gone, and comes back to it. In: where the server is. Out: Welcome, then messages; or one line that says why
// not.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "protocol/connection/server_address.h"
#include "protocol/messages/message.h"

namespace framelet {

class ServerConnection {
public:
    /// Callbacks, all called from the connection's thread. A ProtocolError that `on_message` throws ends the
    /// connection.
    struct Handlers {
        std::function<void(Message)> on_message;
        /// Called once, when an open session has ended for whatever reason but our own, and no other follows; `reason`
        /// is one line.
        std::function<void(std::string reason)> on_lost;
        /// An open session has ended, and another is tried for, for as long as nobody refuses it for good.
        std::function<void(std::string reason)> on_interrupted;
        /// Another session is about to be asked for: adds to Hello what it takes to go on with the one before. Empty:
        /// none is gone on with.
        std::function<void(Hello&)> on_asking;
        /// Another session is open, of which nothing has been delivered or sent yet; `Welcome::resumed` only where
        /// `on_asking` gave a ticket. Where this is empty, none is tried for, whatever the options say.
        std::function<void(Welcome)> on_reopened;
        /// Something that was queued has been sent.
        std::function<void()> on_sent;
    };

    /// Blocks until the session is open. Throws ConnectionError where it cannot be opened, as ConnectionRefusal where
    /// trying again would not help, of these UnknownCertificate where the user may trust it, InputError for a
    /// certificate authority file that cannot be used.
    ServerConnection(ConnectionOptions const& options, Handlers handlers);
    /// Ends the session, and tells the server so. No handler is called afterwards. Not to be called from a handler.
    ~ServerConnection();
    ServerConnection(ServerConnection const&) = delete;
    ServerConnection& operator=(ServerConnection const&) = delete;

    /// The Welcome of the first session.
    Welcome const& welcome() const;
    /// Sends a message; does nothing while no session is open. May be called from any thread.
    void send(Message const& message);
    /// Answers a batch that has been decoded. As `send`, but a web page has answered each when it arrived.
    void acknowledge(Ack const& ack);
    /// True when everything that was queued has been taken by the network. May be called from any thread.
    bool all_sent() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace framelet
