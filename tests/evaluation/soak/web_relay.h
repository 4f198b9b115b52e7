// Carries what a viewer sends and gets in a WebSocket, as a page does. In: the port of a server that answers browsers.
// Out: the port that a viewer connects to instead.
#pragma once

#include <cstdint>
#include <memory>

namespace framelet::bench {

/// A connection that ends on one side ends on the other, amid whatever is on its way.
class WebRelay {
public:
    /// Listens on a free port of 127.0.0.1, opens a session on `server_port` there for each connection. Throws
    /// ConnectionError where it cannot listen.
    explicit WebRelay(std::uint16_t server_port);
    /// Ends every connection.
    ~WebRelay();

    std::uint16_t port() const;

private:
    struct Door;
    std::unique_ptr<Door> door_;
};

} // namespace framelet::bench
