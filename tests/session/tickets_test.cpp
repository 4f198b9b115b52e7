#include "server/session/tickets.h"

#include <gtest/gtest.h>

#include "fake_stream.h"

namespace framelet {
namespace {

using namespace std::chrono_literals;

Tickets::Holder holder(std::uint64_t number) {
    return {{number, 7}, std::make_shared<Session>(number, std::make_shared<FakeStream>(), Session::Events{}),
            number,      {},
            {},          {}};
}

TEST(Tickets, WhoIsAwayForTooLongIsGivenUpTheFirstFirst) {
    Tickets tickets;
    Tickets::Time const start{};
    for (std::uint64_t number = 1; number <= 3; ++number) {
        tickets.issue(holder(number));
    }
    EXPECT_EQ(tickets.longest_parked(), nullptr);
    tickets.find({3, 7})->parked = start;
    tickets.find({2, 7})->parked = start + 10s;
    EXPECT_EQ(tickets.parked_count(), 2u);
    EXPECT_EQ(tickets.overdue(start + Tickets::most_time), nullptr);
    auto const* const late = tickets.overdue(start + Tickets::most_time + 1s);
    ASSERT_NE(late, nullptr);
    EXPECT_EQ(late->session->id(), 3u);
    tickets.erase(late);
    EXPECT_EQ(tickets.overdue(start + Tickets::most_time + 1s), nullptr);
    EXPECT_EQ(tickets.longest_parked()->session->id(), 2u);
    EXPECT_EQ(tickets.find({3, 7}), nullptr);
}

TEST(Tickets, AreFoundByWhatTheyAreAndWhoseTheyAre) {
    Tickets tickets;
    Tickets::Holder const first = holder(1);
    tickets.issue(first);
    tickets.issue(holder(2));
    EXPECT_EQ(tickets.find({1, 7})->session, first.session);
    EXPECT_EQ(tickets.find({1, 8}), nullptr);
    EXPECT_EQ(tickets.of(*first.session)->ticket, first.ticket);
    tickets.erase(tickets.of(*first.session));
    EXPECT_EQ(tickets.of(*first.session), nullptr);
}

} // namespace
} // namespace framelet
