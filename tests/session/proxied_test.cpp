// Viewers that come through a proxy, which says who they are.
#include <sstream>

#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include "common/error.h"
#include "raw_viewer.h"
#include "running_server.h"
#include "server/session/limits/token_guesses.h"

namespace framelet {
namespace {

TEST(Networks, HoldTheirAddresses) {
    Networks networks;
    EXPECT_TRUE(networks.empty());
    networks.add("10.0.0.0/8");
    networks.add("192.0.2.7");
    networks.add("2001:db8::/32");
    for (char const* const inside : {"10.255.0.1", "192.0.2.7", "2001:db8:ffff::1", "::ffff:10.1.2.3"}) {
        EXPECT_TRUE(networks.contains(boost::asio::ip::make_address(inside))) << inside;
    }
    for (char const* const outside : {"11.0.0.1", "192.0.2.8", "2001:db9::1", "::1", "::ffff:11.1.2.3"}) {
        EXPECT_FALSE(networks.contains(boost::asio::ip::make_address(outside))) << outside;
    }
    networks.add("0.0.0.0/0");
    EXPECT_TRUE(networks.contains(boost::asio::ip::make_address("198.51.100.1")));
    for (char const* const word : {"", "10.0.0.0/33", "10.0.0.0/", "10.0.0.0/8x", "example.org", "::/129", "/8"}) {
        EXPECT_THROW(networks.add(word), InputError) << word;
    }
}

Bytes header_from(std::array<unsigned, 4> const& address) {
    Bytes header;
    for (unsigned const byte : {0x0du, 0x0au, 0x0du, 0x0au, 0u, 0x0du, 0x0au,      0x51u,      0x55u,      0x49u,
                                0x54u, 0x0au, 0x21u, 0x11u, 0u, 12u,   address[0], address[1], address[2], address[3],
                                127u,  0u,    0u,    1u,    1u, 2u,    3u,         4u}) {
        header.push_back(static_cast<std::byte>(byte));
    }
    return header;
}

class ProxiedViewer : public RawViewer {
public:
    ProxiedViewer(std::uint16_t port, Bytes const& header, std::string const& token = {}) : RawViewer(port, Silent{}) {
        RawViewer::write(header);
        send(Hello{protocol_version, token, coding::all});
    }
};

ServerOptions behind_proxy() {
    ServerOptions options;
    options.proxies.add("127.0.0.0/8");
    return options;
}

TEST(Proxied, ViewersComeFromWhereTheProxySays) {
    std::ostringstream log;
    auto const before = spdlog::default_logger();
    spdlog::set_default_logger(
        std::make_shared<spdlog::logger>("", std::make_shared<spdlog::sinks::ostream_sink_mt>(log)));
    {
        RunningServer const server(behind_proxy());
        ProxiedViewer viewer(server.port(), header_from({203, 0, 113, 9}));
        auto const first = viewer.receive();
        EXPECT_TRUE(first && std::holds_alternative<Welcome>(*first));
    }
    spdlog::set_default_logger(before);
    EXPECT_NE(log.str().find("connects from 203.0.113.9"), std::string::npos) << log.str();
}

TEST(Proxied, WrongTokensCountForWhoHasSaidThem) {
    ServerOptions options = behind_proxy();
    options.token = "the token of this server";
    RunningServer const server(options);
    for (int i = 0; i < 3; ++i) {
        EXPECT_NE(ProxiedViewer(server.port(), header_from({203, 0, 113, 9}), "a guess").failure(), "");
    }
    auto const seconds_until_let_in = [&](std::array<unsigned, 4> const& address) {
        auto const begun = std::chrono::steady_clock::now();
        ProxiedViewer viewer(server.port(), header_from(address), options.token);
        auto const first = viewer.receive();
        EXPECT_TRUE(first && std::holds_alternative<Welcome>(*first));
        return std::chrono::steady_clock::now() - begun;
    };
    EXPECT_GE(seconds_until_let_in({203, 0, 113, 9}), TokenGuesses::first_delay);
    // However busy the machine is, one of many goes fast where none has to wait.
    auto least = std::chrono::steady_clock::duration::max();
    for (int i = 0; i < 20 && least >= TokenGuesses::first_delay; ++i) {
        least = std::min(least, seconds_until_let_in({203, 0, 113, 10}));
    }
    EXPECT_LT(least, TokenGuesses::first_delay);
}

TEST(Proxied, WithoutAHeaderNobodyIsLetIn) {
    RunningServer const server(behind_proxy());
    RawViewer direct(server.port());
    EXPECT_FALSE(direct.receive());
    Bytes broken = header_from({203, 0, 113, 9});
    broken[15] = std::byte{4}; // too few bytes for the addresses
    EXPECT_FALSE(ProxiedViewer(server.port(), broken).receive());
    ProxiedViewer next(server.port(), header_from({203, 0, 113, 9}));
    EXPECT_TRUE(next.receive()) << "one that breaks the protocol costs the others nothing";
    ServerOptions other;
    other.proxies.add("192.0.2.0/24");
    RunningServer const elsewhere(other);
    EXPECT_TRUE(RawViewer(elsewhere.port()).receive()) << "who is no proxy needs no header";
    EXPECT_NE(ProxiedViewer(elsewhere.port(), header_from({203, 0, 113, 9})).failure(), "")
        << "nor may it say that it is somebody else";
}

TEST(Proxied, WhoSaysNothingGoes) {
    RunningServer const server(behind_proxy());
    Bytes half = header_from({203, 0, 113, 9});
    half.resize(10);
    EXPECT_FALSE(RawViewer(server.port(), coding::all).receive());
    class Silent : public RawViewer {
    public:
        Silent(std::uint16_t port, Bytes const& bytes) : RawViewer(port, RawViewer::Silent{}) {
            RawViewer::write(bytes);
        }
    };
    EXPECT_FALSE(Silent(server.port(), half).receive());
}

} // namespace
} // namespace framelet
