#include "tests/evaluation/soak/web_relay.h"

#include <array>
#include <cstddef>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "common/error.h"

namespace framelet::bench {
namespace {

namespace asio = boost::asio;
namespace websocket = boost::beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;
using boost::system::system_error;
using Step = asio::awaitable<void>;

constexpr std::size_t slice_bytes = 16 << 10;

struct Relayed {
    tcp::socket viewer;
    websocket::stream<tcp::socket> server;

    explicit Relayed(tcp::socket accepted) : viewer(std::move(accepted)), server(viewer.get_executor()) {}

    void close() {
        error_code ignored;
        viewer.close(ignored);
        server.next_layer().close(ignored);
    }
};
using SharedRelayed = std::shared_ptr<Relayed>;

Step carry_up(SharedRelayed relayed) {
    std::array<std::byte, slice_bytes> bytes;
    while (true) {
        std::size_t const count = co_await relayed->viewer.async_read_some(asio::buffer(bytes), asio::use_awaitable);
        co_await relayed->server.async_write(asio::buffer(bytes, count), asio::use_awaitable);
    }
}

Step carry_down(SharedRelayed relayed) {
    std::array<std::byte, slice_bytes> bytes;
    while (true) {
        std::size_t const count = co_await relayed->server.async_read_some(asio::buffer(bytes), asio::use_awaitable);
        co_await asio::async_write(relayed->viewer, asio::buffer(bytes, count), asio::use_awaitable);
    }
}

/// Does the work; closes both sides where one breaks.
Step until_broken(SharedRelayed relayed, Step work) {
    try {
        co_await std::move(work);
    } catch (system_error const&) {
        relayed->close();
    }
}

Step open(SharedRelayed relayed, std::uint16_t server_port) {
    tcp::socket& socket = relayed->server.next_layer();
    co_await socket.async_connect({asio::ip::address_v4::loopback(), server_port}, asio::use_awaitable);
    for (tcp::socket* const side : {&relayed->viewer, &socket}) {
        side->set_option(tcp::no_delay(true));
    }
    relayed->server.binary(true);
    co_await relayed->server.async_handshake("127.0.0.1:" + std::to_string(server_port), "/session",
                                             asio::use_awaitable);
    asio::co_spawn(socket.get_executor(), until_broken(relayed, carry_up(relayed)), asio::detached);
    asio::co_spawn(socket.get_executor(), until_broken(relayed, carry_down(relayed)), asio::detached);
}

} // namespace

struct WebRelay::Door {
    asio::io_context io{1};
    tcp::acceptor acceptor{io};
    std::vector<std::weak_ptr<Relayed>> connections;
    std::uint16_t port = 0;
    std::jthread thread{};

    void listen() {
        try {
            acceptor = tcp::acceptor(io, {asio::ip::address_v4::loopback(), 0});
            port = acceptor.local_endpoint().port();
        } catch (system_error const& error) {
            throw ConnectionError(std::string("relay of WebSockets: cannot listen: ") + error.what());
        }
    }

    Step accept(std::uint16_t server_port) {
        try {
            while (true) {
                auto const relayed = std::make_shared<Relayed>(co_await acceptor.async_accept(asio::use_awaitable));
                std::erase_if(connections, [](auto const& known) { return known.expired(); });
                connections.push_back(relayed);
                asio::co_spawn(io, until_broken(relayed, open(relayed, server_port)), asio::detached);
            }
        } catch (system_error const&) { // closed, or no descriptors are left: viewers are refused
            error_code ignored;
            acceptor.close(ignored);
        }
    }

    void close() {
        error_code ignored;
        acceptor.close(ignored);
        for (auto const& known : connections) {
            if (SharedRelayed const relayed = known.lock()) {
                relayed->close();
            }
        }
    }
};

WebRelay::WebRelay(std::uint16_t server_port) : door_(std::make_unique<Door>()) {
    door_->listen();
    asio::co_spawn(door_->io, door_->accept(server_port), asio::detached);
    door_->thread = std::jthread([this] { door_->io.run(); });
}

WebRelay::~WebRelay() {
    asio::post(door_->io, [this] { door_->close(); });
    door_->thread.join(); // every coroutine ends first, so that none outlives what it refers to
}

std::uint16_t WebRelay::port() const {
    return door_->port;
}

} // namespace framelet::bench
