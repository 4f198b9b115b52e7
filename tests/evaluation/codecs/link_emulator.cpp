#include "tests/evaluation/codecs/link_emulator.h"

#include <algorithm>
#include <chrono>
#include <deque>
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
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>

#include "common/error.h"

namespace framelet::bench {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;
using boost::system::system_error;
using Clock = std::chrono::steady_clock;
using Step = asio::awaitable<void>;

constexpr double slice_seconds = 0.002;
constexpr std::size_t smallest_slice = 128;
constexpr std::size_t largest_slice = 64 << 10;
constexpr double queue_seconds = 0.1;
constexpr double smallest_queue = 64 << 10;
constexpr double unlimited_window = 8 << 20;
constexpr int socket_bytes = 32 << 10; ///< buffers are small, so that bytes wait in the queue or at the sender

/// One direction of the link, for all connections.
class Road {
public:
    Road(LinkParameters const& parameters, Clock::time_point start)
        : link_(parameters), latency_(parameters.delay_seconds + parameters.jitter_seconds), start_(start) {}

    /// Sends bytes now; returns when they are at the receiver.
    Clock::time_point send(std::size_t bytes) {
        std::chrono::duration<double> const arrived{link_.send(now(), bytes).arrived};
        return start_ + std::chrono::ceil<Clock::duration>(arrived);
    }

    std::size_t slice_bytes() const {
        double const rate = link_.rate_at(now());
        auto const slice = static_cast<std::size_t>(std::min(rate / 8 * slice_seconds, double(largest_slice)));
        return rate > 0 ? std::max(slice, smallest_slice) : largest_slice;
    }

    /// Bytes that a connection may have between its sockets.
    double window_bytes() const {
        double const rate = link_.rate_at(now()) / 8;
        return rate > 0 ? std::max(smallest_queue, rate * queue_seconds) + rate * latency_ : unlimited_window;
    }

private:
    double now() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

    SimulatedLink link_;
    double latency_;
    Clock::time_point start_;
};

LinkParameters way_back(LinkParameters const& link) {
    LinkParameters back;
    back.delay_seconds = link.delay_seconds;
    back.jitter_seconds = link.jitter_seconds;
    back.seed = link.seed + 1;
    return back;
}

template <class Socket>
void limit_buffers(Socket& socket) {
    socket.set_option(asio::socket_base::receive_buffer_size(socket_bytes));
    socket.set_option(asio::socket_base::send_buffer_size(socket_bytes));
}

/// The bytes of one connection that are on their way in one direction.
struct Lane {
    struct Slice {
        Clock::time_point arrives;
        std::vector<std::byte> bytes; ///< none: the sender has closed
    };

    tcp::socket& from;
    tcp::socket& to;
    Road& road;
    asio::steady_timer changed, arrival;
    std::deque<Slice> slices{};
    std::size_t held_bytes = 0;

    Lane(tcp::socket& sender, tcp::socket& receiver, Road& way)
        : from(sender), to(receiver), road(way), changed(sender.get_executor(), Clock::time_point::max()),
          arrival(sender.get_executor()) {}
};

struct Connection {
    tcp::socket client, target;
    Lane down, up;
    bool open = true;

    Connection(tcp::socket accepted, Road& road_down, Road& road_up)
        : client(std::move(accepted)), target(client.get_executor()), down(target, client, road_down),
          up(client, target, road_up) {}

    void close() {
        open = false;
        error_code ignored;
        client.close(ignored);
        target.close(ignored);
        for (Lane* const lane : {&down, &up}) {
            lane->changed.cancel();
            lane->arrival.cancel();
        }
    }
};
using SharedConnection = std::shared_ptr<Connection>;

/// Waits until the lane's other end has put a slice in or taken one out, or the connection has ended.
Step wait_for_change(Lane& lane) {
    error_code cancelled; // the timer's cancellation is the signal
    co_await lane.changed.async_wait(asio::redirect_error(asio::use_awaitable, cancelled));
}

Step take_in(SharedConnection connection, Lane& lane) {
    while (connection->open) {
        if (static_cast<double>(lane.held_bytes) >= lane.road.window_bytes()) {
            co_await wait_for_change(lane);
            continue;
        }
        std::vector<std::byte> bytes(lane.road.slice_bytes());
        error_code error;
        bytes.resize(
            co_await lane.from.async_read_some(asio::buffer(bytes), asio::redirect_error(asio::use_awaitable, error)));
        if (error && error != asio::error::eof) {
            throw system_error(error);
        }
        lane.held_bytes += bytes.size();
        auto const arrives = lane.road.send(bytes.size());
        lane.slices.push_back({arrives, std::move(bytes)});
        lane.changed.cancel();
        if (error) {
            co_return;
        }
    }
}

Step hand_out(SharedConnection connection, Lane& lane) {
    while (connection->open) {
        if (lane.slices.empty()) {
            co_await wait_for_change(lane);
            continue;
        }
        Lane::Slice& slice = lane.slices.front();
        lane.arrival.expires_at(slice.arrives);
        co_await lane.arrival.async_wait(asio::use_awaitable);
        if (slice.bytes.empty()) {
            lane.to.shutdown(tcp::socket::shutdown_send);
            co_return;
        }
        co_await asio::async_write(lane.to, asio::buffer(slice.bytes), asio::use_awaitable);
        lane.held_bytes -= slice.bytes.size();
        lane.slices.pop_front();
        lane.changed.cancel();
    }
}

/// Does the work; closes the connection at both ends where it breaks at one.
Step until_broken(SharedConnection connection, Step work) {
    try {
        co_await std::move(work);
    } catch (system_error const&) {
        connection->close();
    }
}

Step serve(SharedConnection connection, std::uint16_t target_port) {
    Connection& c = *connection;
    c.target.open(tcp::v4());
    limit_buffers(c.target); // before connecting: the window that TCP announces follows from it
    co_await c.target.async_connect({asio::ip::address_v4::loopback(), target_port}, asio::use_awaitable);
    for (tcp::socket* const socket : {&c.client, &c.target}) {
        socket->set_option(tcp::no_delay(true));
    }
    for (Lane* const lane : {&c.down, &c.up}) {
        asio::co_spawn(c.client.get_executor(), until_broken(connection, take_in(connection, *lane)), asio::detached);
        asio::co_spawn(c.client.get_executor(), until_broken(connection, hand_out(connection, *lane)), asio::detached);
    }
}

} // namespace

struct LinkEmulator::Proxy {
    asio::io_context io{1};
    tcp::acceptor acceptor{io};
    std::uint16_t target_port;
    Road down, up;
    std::vector<std::weak_ptr<Connection>> connections;
    std::uint16_t port = 0;
    std::jthread thread{};

    Proxy(std::uint16_t target, LinkParameters const& link, Clock::time_point start)
        : target_port(target), down(link, start), up(way_back(link), start) {}

    void listen() {
        try {
            acceptor.open(tcp::v4());
            limit_buffers(acceptor);
            acceptor.bind({asio::ip::address_v4::loopback(), 0});
            acceptor.listen();
            port = acceptor.local_endpoint().port();
        } catch (system_error const& error) {
            throw ConnectionError(std::string("link emulator: cannot listen: ") + error.what());
        }
    }

    Step accept() {
        while (acceptor.is_open()) {
            error_code error;
            tcp::socket socket = co_await acceptor.async_accept(asio::redirect_error(asio::use_awaitable, error));
            if (error) {
                error_code ignored;
                acceptor.close(ignored); // so that clients are refused rather than kept waiting
                co_return;
            }
            auto const connection = std::make_shared<Connection>(std::move(socket), down, up);
            std::erase_if(connections, [](auto const& known) { return known.expired(); });
            connections.push_back(connection);
            asio::co_spawn(io, until_broken(connection, serve(connection, target_port)), asio::detached);
        }
    }

    void close() {
        acceptor.close();
        cut();
    }

    void cut() {
        for (auto const& known : connections) {
            if (SharedConnection const connection = known.lock()) {
                connection->close();
            }
        }
    }
};

LinkEmulator::LinkEmulator(std::uint16_t target_port, LinkParameters const& link)
    : proxy_(std::make_unique<Proxy>(target_port, link, Clock::now())) {
    proxy_->listen();
    asio::co_spawn(proxy_->io, proxy_->accept(), asio::detached);
    proxy_->thread = std::jthread([this] { proxy_->io.run(); });
}

LinkEmulator::~LinkEmulator() {
    asio::post(proxy_->io, [this] { proxy_->close(); });
    proxy_->thread.join(); // every coroutine ends first, so that none outlives what it refers to
}

void LinkEmulator::cut() {
    asio::post(proxy_->io, [this] { proxy_->cut(); });
}

std::uint16_t LinkEmulator::port() const {
    return proxy_->port;
}

} // namespace framelet::bench
