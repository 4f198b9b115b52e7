// Connects to a host that has several addresses, of which some may not answer. In: its addresses. Out: the first socket
// that is connected.
#pragma once

#include <functional>
#include <list>
#include <vector>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

namespace framelet {

/// The addresses, of which there is one at least, with IPv6 and IPv4 in turn (RFC 8305, section 4), those of each
/// family in their order.
std::vector<boost::asio::ip::tcp::endpoint> alternating(std::vector<boost::asio::ip::tcp::endpoint> addresses);

/// Tries the addresses in turn: the next one once one has failed, or has not answered for 250 ms (RFC 8305, section 5);
/// those before it go on. Families alternate. Used by one thread.
class AddressRace {
public:
    using Tcp = boost::asio::ip::tcp;
    using Error = boost::system::error_code;
    /// Is called once: with the socket, or with why the last attempt that failed did.
    using Handler = std::function<void(Error, Tcp::socket)>;

    explicit AddressRace(boost::asio::io_context& io) : io_(io), next_(io) {}

    /// Begins with at least one address. What was begun before ends without a call.
    void start(std::vector<Tcp::endpoint> const& addresses, Handler handler);
    /// Ends without a call.
    void cancel();

private:
    void try_next();
    void take_result(std::list<Tcp::socket>::iterator tried, Error error);

    boost::asio::io_context& io_;
    boost::asio::steady_timer next_;
    std::vector<Tcp::endpoint> waiting_; ///< the next one last
    std::list<Tcp::socket> tried_;
    Handler handler_;
    unsigned race_ = 0; ///< callbacks of earlier ones are not heard
};

} // namespace framelet
