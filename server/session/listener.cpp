#include "server/session/listener.h"

#include <algorithm>
#include <exception>
#include <new>
#include <utility>

#include <boost/asio/ip/v6_only.hpp>
#include <spdlog/spdlog.h>

namespace framelet {

namespace asio = boost::asio;
using asio::ip::tcp;
using Error = boost::system::error_code;

namespace {

/// How often all addresses are tried with port 0, since the port that is free on the first may not be on the next.
constexpr int attempts = 16;

/// True where this machine has no such address: a name may stand for one of a version of IP that it does not speak.
bool is_absent(Error const& error) {
    return error == asio::error::address_family_not_supported || error == boost::system::errc::address_not_available;
}

} // namespace

std::string text_of(tcp::endpoint const& endpoint) {
    std::string const host = endpoint.address().to_string();
    return (endpoint.address().is_v6() ? "[" + host + "]" : host) + ":" + std::to_string(endpoint.port());
}

Listener::Listener(std::string const& bind, std::uint16_t port) : advice_("choose another --port or --bind") {
    std::string const place = bind + ":" + std::to_string(port);
    Error error;
    std::vector<asio::ip::address> addresses;
    tcp::resolver resolver(io);
    for (auto const& found :
         resolver.resolve(bind, std::to_string(port), tcp::resolver::passive | tcp::resolver::numeric_service, error)) {
        asio::ip::address const address = found.endpoint().address();
        if (std::find(addresses.begin(), addresses.end(), address) == addresses.end()) {
            addresses.push_back(address);
        }
    }
    if (error || addresses.empty()) {
        throw InputError("cannot listen on " + place + ": no such address: give --bind an address of this machine");
    }
    this->bind(addresses, port, place);
}

Listener::Listener(std::vector<asio::ip::address> const& addresses, std::uint16_t port, std::string advice)
    : advice_(std::move(advice)) {
    bind(addresses, port, text_of({addresses.at(0), port}));
}

InputError Listener::cannot_listen(std::string const& place, Error const& error) const {
    return InputError("cannot listen on " + place + ": " + error.message() + ": " + advice_);
}

void Listener::bind(std::vector<asio::ip::address> const& addresses, std::uint16_t port, std::string const& place) {
    Error failed;
    for (int attempt = 0; attempt < (port == 0 ? attempts : 1); ++attempt) {
        doors_.clear();
        failed.clear();
        Error absent;
        std::uint16_t common_port = port;
        for (asio::ip::address const& address : addresses) {
            Error const error = bind({address, common_port}, addresses.size() > 1);
            (is_absent(error) ? absent : failed) = error;
            if (failed) {
                break;
            }
            common_port = doors_.empty() ? port : doors_.front().acceptor.local_endpoint().port();
        }
        if (!failed && doors_.empty()) {
            failed = absent;
        }
        if (!failed) {
            return;
        }
    }
    doors_.clear();
    throw cannot_listen(place, failed);
}

Error Listener::bind(Endpoint const& endpoint, bool only_this_version) {
    Error error;
    tcp::acceptor acceptor(io);
    acceptor.open(endpoint.protocol(), error);
    if (!error) {
        acceptor.set_option(tcp::acceptor::reuse_address(true), error);
    }
    // A socket for all addresses of IPv6 by itself takes those of IPv4 as well, which could not be bound then.
    if (!error && endpoint.address().is_v6() && only_this_version) {
        acceptor.set_option(asio::ip::v6_only(true), error);
    }
    if (!error) {
        acceptor.bind(endpoint, error);
    }
    if (!error) {
        doors_.push_back({std::move(acceptor), asio::steady_timer(io)});
    }
    return error;
}

void Listener::listen() {
    for (Door& door : doors_) {
        Error error;
        door.acceptor.listen(asio::socket_base::max_listen_connections, error);
        if (error) {
            throw cannot_listen(text_of(door.acceptor.local_endpoint()), error);
        }
    }
}

void Listener::accept(std::function<void(tcp::socket)> take) {
    take_ = std::move(take);
    accept_again();
}

void Listener::accept_again() {
    for (Door& door : doors_) {
        if (!door.waits && door.acceptor.is_open()) {
            accept_at(door);
        }
    }
}

void Listener::accept_at(Door& door) {
    door.acceptor.async_accept([this, &door](Error error, tcp::socket socket) {
        door.waits = false;
        if (!door.acceptor.is_open()) {
            return;
        }
        std::string failure = error ? error.message() : "";
        if (!error) {
            try {
                take_(std::move(socket));
            } catch (std::bad_alloc const&) { // that connection is closed
                failure = "no memory left";
            } catch (std::exception const& thrown) {
                failure = thrown.what();
            }
        }
        if (failure.empty()) {
            accept_at(door);
            return;
        }
        if (auto const more = failures_.next(std::chrono::steady_clock::now())) {
            spdlog::warn("cannot accept a connection: {}{}", failure, *more);
        }
        door.again.expires_after(pause);
        door.again.async_wait([this, &door](Error) {
            door.waits = false;
            if (door.acceptor.is_open()) {
                accept_at(door);
            }
        });
        door.waits = true;
    });
    door.waits = true;
}

void Listener::close() {
    for (Door& door : doors_) {
        Error ignored;
        door.acceptor.close(ignored);
        door.again.cancel();
    }
}

std::vector<Listener::Endpoint> Listener::endpoints() const {
    std::vector<Endpoint> all;
    for (Door const& door : doors_) {
        all.push_back(door.acceptor.local_endpoint());
    }
    return all;
}

} // namespace framelet
