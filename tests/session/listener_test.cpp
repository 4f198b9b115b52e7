#include "server/session/listener.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "common/error.h"

namespace framelet {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

bool is_here(asio::ip::address const& address) {
    asio::io_context io;
    tcp::acceptor acceptor(io);
    boost::system::error_code error;
    acceptor.open(tcp::endpoint(address, 0).protocol(), error);
    if (!error) {
        acceptor.bind({address, 0}, error);
    }
    return !error;
}

TEST(Listener, AcceptsAtAllAddressesThatThereAre) {
    std::vector<asio::ip::address> here;
    std::vector<asio::ip::address> const all{asio::ip::make_address("::1"), asio::ip::make_address("127.0.0.1"),
                                             asio::ip::make_address("127.0.0.2")};
    std::copy_if(all.begin(), all.end(), std::back_inserter(here), is_here);
    ASSERT_FALSE(here.empty());
    Listener listener(all, 0);
    auto const endpoints = listener.endpoints();
    ASSERT_EQ(endpoints.size(), here.size());
    listener.listen();
    std::size_t accepted = 0;
    listener.accept([&](tcp::socket) {
        if (++accepted == here.size()) {
            listener.close();
        }
    });
    asio::io_context io;
    std::vector<tcp::socket> viewers;
    for (std::size_t i = 0; i < here.size(); ++i) {
        EXPECT_EQ(endpoints[i].port(), endpoints[0].port());
        viewers.emplace_back(io).connect({here[i], endpoints[0].port()});
    }
    listener.io.run();
    EXPECT_EQ(accepted, here.size());
}

TEST(Listener, WhateverFailsForOneConnectionTheNextIsAccepted) {
    Listener listener({asio::ip::address_v4::loopback()}, 0);
    listener.listen();
    int accepted = 0;
    listener.accept([&](tcp::socket) {
        switch (++accepted) {
        case 1:
            throw std::bad_alloc();
        case 2:
            throw boost::system::system_error(asio::error::access_denied);
        default:
            listener.close();
        }
    });
    asio::io_context io;
    std::vector<tcp::socket> viewers;
    for (int i = 0; i < 3; ++i) {
        viewers.emplace_back(io).connect(listener.endpoints().front());
    }
    listener.io.run();
    EXPECT_EQ(accepted, 3);
}

TEST(Listener, BothVersionsOfAllAddressesGoTogether) {
    std::vector<asio::ip::address> const all{asio::ip::address_v6::any(), asio::ip::address_v4::any()};
    EXPECT_EQ(Listener(all, 0).endpoints().size(), is_here(all[0]) ? 2u : 1u);
}

/// What a name stands for, as far as it is here. No name stands for all addresses, and "localhost" for one or two.
TEST(Listener, ANameStandsForAllItsAddresses) {
    asio::io_context io;
    for (std::string const name : {"localhost", ""}) {
        std::set<asio::ip::address> wanted, bound;
        std::set<std::uint16_t> ports;
        for (auto const& found : tcp::resolver(io).resolve(name, "0", tcp::resolver::passive)) {
            if (is_here(found.endpoint().address())) {
                wanted.insert(found.endpoint().address());
            }
        }
        for (auto const& endpoint : Listener(name, 0).endpoints()) {
            bound.insert(endpoint.address());
            ports.insert(endpoint.port());
        }
        EXPECT_FALSE(wanted.empty()) << name;
        EXPECT_EQ(bound, wanted) << name;
        EXPECT_EQ(ports.size(), 1u) << name;
    }
}

TEST(Listener, AddressesOfOtherMachinesAreRefusedWhereThereIsNoOther) {
    asio::ip::address const other = asio::ip::make_address("192.0.2.1");
    EXPECT_THROW(Listener({other}, 0), InputError);
    EXPECT_EQ(Listener({other, asio::ip::address_v4::loopback()}, 0).endpoints().size(), 1u);
    EXPECT_THROW(Listener("no.such.host.invalid", 0), InputError);
}

TEST(Listener, APortInUseIsRefusedWhateverTheOtherAddresses) {
    Listener first({asio::ip::address_v4::loopback()}, 0);
    first.listen();
    auto const port = first.endpoints().front().port();
    EXPECT_THROW(Listener({asio::ip::make_address("127.0.0.2"), asio::ip::address_v4::loopback()}, port), InputError);
}

} // namespace
} // namespace framelet
