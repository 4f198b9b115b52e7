// A stranger who begins TLS handshakes with the real server without end, while a viewer comes.
#include <algorithm>
#include <atomic>
#include <csignal>
#include <memory>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "tests/faults/tls_viewer.h"
#include "tests/loopback/process.h"

namespace framelet::test {
namespace {

/// The first message of a TLS handshake.
std::string client_hello() {
    std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)> const context(SSL_CTX_new(TLS_client_method()), SSL_CTX_free);
    std::unique_ptr<SSL, decltype(&SSL_free)> const tls(SSL_new(context.get()), SSL_free);
    BIO* const said = BIO_new(BIO_s_mem());
    SSL_set_bio(tls.get(), BIO_new(BIO_s_mem()), said);
    SSL_connect(tls.get());
    std::string bytes(4096, '\0');
    bytes.resize(static_cast<std::size_t>(std::max(0, BIO_read(said, bytes.data(), static_cast<int>(bytes.size())))));
    return bytes;
}

/// Each of these handshakes costs the server a signature of milliseconds, and the stranger nothing.
TEST(HandshakeFlood, LocksNobodyOutWhoComesFromElsewhere) {
    ::signal(SIGPIPE, SIG_IGN);
    TemporaryFolder const folder;
    auto const [certificate, key] = make_certificate(folder, "own", "rsa:4096");
    ServerProcess const server(FRAMELET_SOURCE_DIR "/scenes/vehicle_chase.glb",
                               {"--tls-cert", certificate, "--tls-key", key, "--insecure", "--paused"});
    auto const port = static_cast<std::uint16_t>(std::stoi(server.address().substr(server.address().rfind(':') + 1)));
    std::string const hello = client_hello();
    ASSERT_FALSE(hello.empty());
    std::atomic<int> begun = 0;
    std::jthread const flood([&](std::stop_token const& stop) {
        boost::asio::io_context io;
        while (!stop.stop_requested()) {
            boost::system::error_code ignored;
            boost::asio::ip::tcp::socket socket(io);
            socket.connect({boost::asio::ip::address_v4::loopback(), port}, ignored);
            socket.send(boost::asio::buffer(hello), 0, ignored);
            ++begun;
        }
    });
    ASSERT_TRUE(eventually([&] { return begun > 2000; }));
    for (int i = 0; i < 3; ++i) {
        TlsViewer viewer(port, {protocol_version, {}, coding::all}, boost::asio::ip::make_address_v4("127.0.0.2"));
        EXPECT_TRUE(viewer.watch([](Message const& message) { return std::holds_alternative<Welcome>(message); })) << i;
    }
}

} // namespace
} // namespace framelet::test
