// The sockets that viewers connect to. A resource, made before the scene is loaded: what is wrong with the address is
// known at once, and until `accept` whoever connects is refused by the system, not kept waiting. In: addresses. Out:
// connected sockets.
#pragma once

#include <deque>
#include <functional>
#include <string>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include "common/error.h"
#include "server/session/limits/log_limit.h"

namespace framelet {

/// Address and port, as a viewer is told them.
std::string text_of(boost::asio::ip::tcp::endpoint const& endpoint);

class Listener {
public:
    using Endpoint = boost::asio::ip::tcp::endpoint;

    /// Time to wait after the system could not give a connection, most likely for want of file descriptors. It would
    /// say so again at once: the connection goes on waiting.
    static constexpr std::chrono::milliseconds pause{100};

    /// Binds to all addresses that `bind`, a name or an address, stands for; port 0: any one that is free on all of
    /// them. Throws InputError where that cannot be had.
    Listener(std::string const& bind, std::uint16_t port);
    /// The same for given addresses. Those that this machine has not are left out, unless there is no other. `advice`
    /// ends what an InputError says.
    Listener(std::vector<boost::asio::ip::address> const& addresses, std::uint16_t port,
             std::string advice = "choose another --port or --bind");

    /// Lets viewers connect. Throws InputError where another program has begun to listen there meanwhile.
    void listen();
    /// Hands over each socket that connects, from `io`'s thread, until `close`.
    void accept(std::function<void(boost::asio::ip::tcp::socket)> take);
    /// Goes on accepting where memory was missing for that.
    void accept_again();
    void close();

    /// Endpoints that it listens on, with the real port; at least one.
    std::vector<Endpoint> endpoints() const;

    boost::asio::io_context io{1}; ///< also for what is connected

private:
    struct Door {
        boost::asio::ip::tcp::acceptor acceptor;
        boost::asio::steady_timer again;
        bool waits = false; ///< for a connection, or for the pause to be over
    };

    void bind(std::vector<boost::asio::ip::address> const& addresses, std::uint16_t port, std::string const& place);
    boost::system::error_code bind(Endpoint const& endpoint, bool only_this_version);
    void accept_at(Door& door);
    InputError cannot_listen(std::string const& place, boost::system::error_code const& error) const;

    std::string const advice_;
    std::deque<Door> doors_; // which stay where they are
    std::function<void(boost::asio::ip::tcp::socket)> take_;
    LogLimit failures_;
};

} // namespace framelet
