// Finds out who connects: the other side of a socket or, where that is a proxy, whoever connects by it. A resource on
// the io thread. In: sockets. Out: sockets, with addresses.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <boost/asio/ip/tcp.hpp>

#include "server/session/limits/networks.h"

namespace framelet {

class ProxyHall {
public:
    using Socket = boost::asio::ip::tcp::socket;
    using Address = boost::asio::ip::address;
    /// `peer`: who a proxy says it is, for the log; else empty.
    using Enter = std::function<void(Socket, Address const& source, std::string const& peer)>;

    /// A proxy says at once for whom it connects.
    static constexpr std::chrono::seconds patience{3};
    static constexpr std::size_t most = 256; ///< proxies' connections that wait at a time

    explicit ProxyHall(Networks proxies) : proxies_(std::move(proxies)) {}

    /// Calls `enter`, where a proxy connects once its header of [PROXY protocol] version 2 has come. Where none comes,
    /// which `fail` is told in a line, the connection is closed.
    void take(Socket socket, Enter enter, std::function<void(std::string const&)> fail);
    /// Closes all that wait.
    void close();

private:
    struct Visit;
    Networks const proxies_;
    std::vector<std::weak_ptr<Visit>> visits_;
};

} // namespace framelet
