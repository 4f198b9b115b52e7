#include "protocol/connection/address_race.h"

#include <list>
#include <optional>

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>

namespace framelet {
namespace {

using Tcp = AddressRace::Tcp;

class AddressRaceTest : public testing::Test {
protected:
    Tcp::endpoint of(Tcp::acceptor const& acceptor) const { return acceptor.local_endpoint(); }

    /// An address that answers.
    Tcp::acceptor listening() { return Tcp::acceptor(io, Tcp::endpoint(boost::asio::ip::address_v4::loopback(), 0)); }

    /// An address that does not answer: connections that nobody accepts have filled its queue.
    Tcp::endpoint silent() {
        full.open(Tcp::v4());
        full.bind(Tcp::endpoint(boost::asio::ip::address_v4::loopback(), 0));
        full.listen(0);
        for (int i = 0; i < 8; ++i) {
            waiting.emplace_back(io).async_connect(of(full), [](auto) {});
        }
        io.poll();
        return of(full);
    }

    /// Whom the race is won by; nobody where it is lost.
    std::optional<Tcp::endpoint> winner(std::vector<Tcp::endpoint> const& addresses) {
        std::optional<Tcp::endpoint> found;
        io.restart();
        bool is_over = false;
        race.start(addresses, [&](AddressRace::Error error, Tcp::socket socket) {
            EXPECT_FALSE(is_over);
            is_over = true;
            if (!error) {
                found = socket.remote_endpoint();
            }
        });
        while (!is_over && io.run_one() > 0) {
        }
        EXPECT_TRUE(is_over);
        return found;
    }

    boost::asio::io_context io;
    Tcp::acceptor full{io};
    std::list<Tcp::socket> waiting;
    AddressRace race{io};
};

TEST_F(AddressRaceTest, AnAddressThatDoesNotAnswerIsNotWaitedFor) {
    Tcp::acceptor const good = listening();
    Tcp::endpoint const mute = silent();
    EXPECT_EQ(winner({mute, of(good)}), of(good));
    EXPECT_EQ(winner({mute, mute, of(good)}), of(good));
}

TEST_F(AddressRaceTest, AnAddressThatRefusesIsFollowedByTheNext) {
    Tcp::endpoint closed;
    {
        Tcp::acceptor const acceptor = listening();
        closed = of(acceptor);
    }
    Tcp::acceptor const good = listening();
    EXPECT_EQ(winner({closed, of(good)}), of(good));
    EXPECT_EQ(winner({of(good), closed}), of(good));
    EXPECT_EQ(winner({closed, closed}), std::nullopt);
}

TEST_F(AddressRaceTest, FamiliesAlternate) {
    auto const at = [](char const* address) { return Tcp::endpoint(boost::asio::ip::make_address(address), 1); };
    std::vector<Tcp::endpoint> const wanted{at("::1"), at("10.0.0.1"), at("::2"), at("::3")};
    EXPECT_EQ(alternating({at("::1"), at("::2"), at("::3"), at("10.0.0.1")}), wanted);
    EXPECT_EQ(alternating({at("::1"), at("10.0.0.1"), at("::2"), at("::3")}), wanted);
    EXPECT_EQ(alternating({at("::1")}), std::vector{at("::1")});
}

TEST_F(AddressRaceTest, WhatIsCancelledIsSilent) {
    Tcp::acceptor const good = listening();
    race.start({of(good)}, [](auto, auto) { ADD_FAILURE() << "called"; });
    race.cancel();
    io.run();
}

} // namespace
} // namespace framelet
