#include "server/session/proxy_hall.h"

#include <array>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/steady_timer.hpp>

#include "protocol/stream/proxy_header.h"

namespace framelet {

namespace asio = boost::asio;
using Error = boost::system::error_code;

struct ProxyHall::Visit : std::enable_shared_from_this<Visit> {
    Visit(Socket from, Address const& by, Enter to_enter, std::function<void(std::string const&)> to_fail)
        : socket(std::move(from)), timer(socket.get_executor()), proxy(by), enter(std::move(to_enter)),
          fail(std::move(to_fail)) {}

    void read_start() {
        timer.expires_after(patience);
        timer.async_wait([self = shared_from_this()](Error aborted) {
            if (!aborted) {
                self->close();
            }
        });
        asio::async_read(socket, asio::buffer(bytes, proxy_header_start),
                         [self = shared_from_this()](Error error, std::size_t) {
                             error ? self->end("no header of PROXY protocol has come from " + self->proxy.to_string())
                                   : self->read_rest();
                         });
    }

    void read_rest() {
        auto const rest = rest_of_proxy_header(std::span(bytes).first(proxy_header_start));
        if (!rest) {
            end(proxy.to_string() + " does not begin with a header of PROXY protocol, version 2, as --proxied demands");
            return;
        }
        size = proxy_header_start + *rest;
        asio::async_read(socket, asio::buffer(bytes.data() + proxy_header_start, *rest),
                         [self = shared_from_this()](Error error, std::size_t) { self->take_header(error); });
    }

    void take_header(Error error) {
        ProxiedSource const source =
            error ? ProxiedSource{} : parse_proxy_header(std::span<std::uint8_t const>(bytes).first(size));
        if (!source.is_valid) {
            end("a header of PROXY protocol from " + proxy.to_string() + " breaks off");
            return;
        }
        timer.cancel();
        Address const who = source.address.value_or(proxy);
        enter(std::move(socket), who, who.to_string());
    }

    void end(std::string const& reason) {
        timer.cancel();
        close();
        fail(reason);
    }

    void close() {
        Error ignored;
        socket.close(ignored);
    }

    Socket socket;
    asio::steady_timer timer;
    Address const proxy;
    Enter const enter;
    std::function<void(std::string const&)> const fail;
    std::array<std::uint8_t, proxy_header_start + most_of_proxy_header> bytes{};
    std::size_t size = 0; ///< of the header
};

void ProxyHall::take(Socket socket, Enter enter, std::function<void(std::string const&)> fail) {
    Error error;
    auto const endpoint = socket.remote_endpoint(error);
    if (error) {
        return; // it is gone already
    }
    if (!proxies_.contains(endpoint.address())) {
        enter(std::move(socket), endpoint.address(), "");
        return;
    }
    std::erase_if(visits_, [](auto const& visit) { return visit.expired(); });
    if (visits_.size() == most) {
        fail("too many connections from proxies at a time have not said yet for whom they are");
        return;
    }
    auto const visit =
        std::make_shared<Visit>(std::move(socket), endpoint.address(), std::move(enter), std::move(fail));
    visits_.push_back(visit);
    visit->read_start();
}

void ProxyHall::close() {
    for (auto const& weak : visits_) {
        if (auto const visit = weak.lock()) {
            visit->timer.cancel();
            visit->close();
        }
    }
}

} // namespace framelet
