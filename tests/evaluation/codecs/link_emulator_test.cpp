#include "tests/evaluation/codecs/link_emulator.h"

#include <chrono>
#include <functional>
#include <random>
#include <thread>
#include <vector>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <gtest/gtest.h>

#include "common/error.h"

namespace framelet::bench {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;
using Bytes = std::vector<unsigned char>;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// A server of one connection, which `serve` handles on a thread of its own.
class Server {
public:
    explicit Server(std::function<void(tcp::socket&)> serve)
        : thread_([this, serve = std::move(serve)] {
              tcp::socket socket = acceptor_.accept();
              serve(socket);
          }) {}

    std::uint16_t port() const { return acceptor_.local_endpoint().port(); }

private:
    asio::io_context io_;
    tcp::acceptor acceptor_{io_, {asio::ip::address_v4::loopback(), 0}};
    std::jthread thread_; // declared last, so that it ends before what it uses
};

struct Client {
    asio::io_context io;
    tcp::socket socket{io};

    explicit Client(std::uint16_t port) {
        socket.connect({asio::ip::address_v4::loopback(), port});
        socket.set_option(tcp::no_delay(true));
    }
    /// Reads all bytes that come until the other side closes.
    Bytes read_all() {
        Bytes bytes;
        error_code end;
        asio::read(socket, asio::dynamic_buffer(bytes), end);
        EXPECT_EQ(end, asio::error::eof);
        return bytes;
    }
};

Bytes random_bytes(std::size_t count) {
    std::mt19937 random(7);
    Bytes bytes(count);
    std::ranges::generate(bytes, [&] { return static_cast<unsigned char>(random()); });
    return bytes;
}

void echo(tcp::socket& socket) {
    Bytes buffer(4096);
    error_code error;
    while (std::size_t const count = socket.read_some(asio::buffer(buffer), error)) {
        asio::write(socket, asio::buffer(buffer.data(), count));
    }
}

/// Sends until the other side is gone; `ended` says why.
void send_without_end(tcp::socket& socket, error_code& ended) {
    Bytes const block(16384);
    while (!ended) {
        asio::write(socket, asio::buffer(block), ended);
    }
}

TEST(LinkEmulator, BytesPassUnchangedAndAHalfCloseBehindThem) {
    Server server(echo);
    LinkParameters link;
    link.bits_per_second = 20e6;
    link.delay_seconds = 0.005;
    link.jitter_seconds = 0.005;
    link.stalls = {{0.05, 0.05}};
    LinkEmulator const emulator(server.port(), link);
    Client client(emulator.port());
    Bytes const sent = random_bytes(300'000);
    std::jthread const writing([&] {
        asio::write(client.socket, asio::buffer(sent));
        client.socket.shutdown(tcp::socket::shutdown_send); // the server still has much to return
    });
    EXPECT_TRUE(client.read_all() == sent);
}

TEST(LinkEmulator, DelaysEachWay) {
    Server server(echo);
    LinkParameters link;
    link.delay_seconds = 0.03;
    LinkEmulator const emulator(server.port(), link);
    Client client(emulator.port());
    for (unsigned char i = 0; i < 5; ++i) {
        auto const start = Clock::now();
        asio::write(client.socket, asio::buffer(&i, 1));
        unsigned char answer = 255;
        asio::read(client.socket, asio::buffer(&answer, 1));
        EXPECT_EQ(answer, i);
        EXPECT_GE(seconds_since(start), 0.06);
        EXPECT_LT(seconds_since(start), 1);
    }
}

/// Rate, bits a second, at which a client receives from a server that sends without end.
double measure_rate(LinkParameters const& link, std::size_t bytes) {
    error_code closed;
    Server server([&](tcp::socket& socket) { send_without_end(socket, closed); });
    LinkEmulator const emulator(server.port(), link);
    Client client(emulator.port());
    Bytes received(bytes);
    asio::read(client.socket, asio::buffer(received, 1));
    auto const start = Clock::now();
    asio::read(client.socket, asio::buffer(received));
    return 8 * static_cast<double>(bytes) / seconds_since(start);
}

TEST(LinkEmulator, KeepsItsRate) {
    LinkParameters link;
    link.bits_per_second = 8e6;
    double rate = 0;
    for (int attempt = 0; attempt < 3 && rate < 0.85 * 8e6; ++attempt) { // since a busy machine may take time away
        rate = measure_rate(link, 500'000);
        EXPECT_LT(rate, 1.15 * 8e6);
    }
    EXPECT_GT(rate, 0.85 * 8e6);
}

TEST(LinkEmulator, AnUnlimitedLinkIsFast) {
    EXPECT_GT(measure_rate({}, 4'000'000), 50e6);
}

TEST(LinkEmulator, AFullQueueIsFeltByTheSender) {
    std::size_t accepted = 0;
    {
        Server server([&](tcp::socket& socket) {
            socket.set_option(asio::socket_base::send_buffer_size(16384));
            socket.non_blocking(true);
            Bytes const block(4096);
            auto const start = Clock::now();
            while (seconds_since(start) < 0.3) {
                error_code full;
                accepted += socket.write_some(asio::buffer(block), full);
                std::this_thread::sleep_for(std::chrono::microseconds(full ? 1000 : 0));
            }
        });
        LinkParameters link;
        link.bits_per_second = 1e6;
        LinkEmulator const emulator(server.port(), link);
        Client const client(emulator.port());
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
    }
    EXPECT_GT(accepted, 64u << 10) << "the queue";
    EXPECT_LT(accepted, 512u << 10) << "the queue, the sockets and what the link carried meanwhile";
}

TEST(LinkEmulator, AClientThatIsGoneEndsTheServersWriting) {
    error_code ended;
    {
        Server server([&](tcp::socket& socket) { send_without_end(socket, ended); });
        LinkEmulator const emulator(server.port(), {});
        Client client(emulator.port());
        unsigned char first = 0;
        asio::read(client.socket, asio::buffer(&first, 1));
        client.socket.close();
        // The server's thread ends only once its connection does, and the emulator outlives neither.
    }
    EXPECT_TRUE(ended);
}

TEST(LinkEmulator, WithoutAServerTheClientIsClosed) {
    std::uint16_t nobody = 0;
    {
        asio::io_context io;
        nobody = tcp::acceptor(io, {asio::ip::address_v4::loopback(), 0}).local_endpoint().port();
    }
    LinkEmulator const emulator(nobody, {});
    Client client(emulator.port());
    EXPECT_TRUE(client.read_all().empty());
}

TEST(LinkEmulator, EndsWithBytesOnTheirWay) {
    error_code ended;
    Server server([&](tcp::socket& socket) { send_without_end(socket, ended); });
    LinkParameters link;
    link.bits_per_second = 1e6;
    link.delay_seconds = 100;
    auto const start = Clock::now();
    {
        LinkEmulator const emulator(server.port(), link);
        Client const client(emulator.port());
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    EXPECT_LT(seconds_since(start), 10);
}

TEST(LinkEmulator, ACutEndsWhoIsThereAndLetsTheNextOneThrough) {
    std::string const word = "welcome";
    asio::io_context io;
    tcp::acceptor acceptor(io, {asio::ip::address_v4::loopback(), 0});
    LinkEmulator emulator(acceptor.local_endpoint().port(), {});
    for (int i = 0; i < 3; ++i) {
        Client client(emulator.port());
        tcp::socket served = acceptor.accept();
        asio::write(served, asio::buffer(word));
        Bytes came(word.size());
        asio::read(client.socket, asio::buffer(came)); // before the first bytes the connection might not be made yet
        EXPECT_EQ(std::string(came.begin(), came.end()), word);
        emulator.cut();
        EXPECT_TRUE(client.read_all().empty());
        error_code ended;
        unsigned char byte = 0;
        asio::read(served, asio::buffer(&byte, 1), ended);
        EXPECT_TRUE(ended);
    }
}

TEST(LinkEmulator, RefusesWhatNoLinkIs) {
    LinkParameters link;
    link.delay_seconds = -1;
    EXPECT_THROW(LinkEmulator(1, link), InputError);
}

} // namespace
} // namespace framelet::bench
