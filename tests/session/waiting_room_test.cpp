#include "server/session/limits/waiting_room.h"

#include <random>
#include <set>

#include <gtest/gtest.h>

namespace framelet {
namespace {

constexpr double certainly = 0;
constexpr double hardly = 0.999999;

/// Lets in `count` connections, numbered from `first` on, each of a source of its own.
void fill(WaitingRoom& room, std::uint64_t first, std::size_t count) {
    for (std::uint64_t i = first; i < first + count; ++i) {
        EXPECT_EQ(room.enter(i, "source " + std::to_string(i), hardly), std::nullopt);
    }
}

TEST(WaitingRoom, NobodyGoesWhileFewWait) {
    WaitingRoom room;
    for (std::uint64_t i = 0; i < WaitingRoom::early; ++i) {
        EXPECT_EQ(room.enter(i, std::to_string(i), certainly), std::nullopt);
    }
}

TEST(WaitingRoom, ASourceHasItsShareAndNoMore) {
    WaitingRoom room;
    room.enter(1000, "another", certainly);
    std::mt19937 random(1);
    for (std::uint64_t i = 0; i < 500; ++i) {
        auto const dropped = room.enter(i, "flood", std::uniform_real_distribution<>()(random));
        EXPECT_EQ(dropped.has_value(), i >= WaitingRoom::most_of_a_source);
        EXPECT_NE(dropped, 1000u) << "what others do is not its fault";
        EXPECT_NE(dropped, i) << "whoever comes is heard";
    }
}

TEST(WaitingRoom, DropsEarlyByChance) {
    auto const dropped_of = [](std::size_t waiting, double chance) {
        WaitingRoom room;
        fill(room, 0, waiting);
        return room.enter(1000, "late", chance).has_value();
    };
    constexpr std::size_t half = (WaitingRoom::early + WaitingRoom::most) / 2;
    constexpr double half_drop = (WaitingRoom::least_drop + 1) / 2;
    EXPECT_TRUE(dropped_of(WaitingRoom::early, WaitingRoom::least_drop - 0.01));
    EXPECT_FALSE(dropped_of(WaitingRoom::early, WaitingRoom::least_drop + 0.01));
    EXPECT_TRUE(dropped_of(half, half_drop - 0.01));
    EXPECT_FALSE(dropped_of(half, half_drop + 0.01));
    EXPECT_TRUE(dropped_of(WaitingRoom::most, hardly));
}

TEST(WaitingRoom, IsNeverFullerThanItMay) {
    WaitingRoom room;
    fill(room, 0, WaitingRoom::most);
    std::set<std::uint64_t> gone;
    for (std::uint64_t i = 1000; i < 2000; ++i) {
        auto const dropped = room.enter(i, std::to_string(i), hardly);
        ASSERT_TRUE(dropped);
        EXPECT_TRUE(gone.insert(*dropped).second) << "whoever has gone waits no more";
    }
}

TEST(WaitingRoom, OneOfTheSourceWithMostGoes) {
    WaitingRoom room;
    for (std::uint64_t i = 0; i < WaitingRoom::most_of_a_source; ++i) {
        room.enter(i, "many", hardly);
    }
    fill(room, 100, WaitingRoom::most - WaitingRoom::most_of_a_source);
    auto const dropped = room.enter(1000, "late", 0.5);
    ASSERT_TRUE(dropped);
    EXPECT_LT(*dropped, WaitingRoom::most_of_a_source);
}

TEST(WaitingRoom, AllOfASourceAreAsLikelyToGo) {
    std::set<std::uint64_t> dropped;
    for (std::size_t i = 0; i < WaitingRoom::most_of_a_source; ++i) {
        WaitingRoom room;
        for (std::uint64_t c = 0; c < WaitingRoom::most_of_a_source; ++c) {
            room.enter(c, "one", hardly);
        }
        dropped.insert(*room.enter(1000, "one", (static_cast<double>(i) + 0.5) / WaitingRoom::most_of_a_source));
    }
    EXPECT_EQ(dropped.size(), WaitingRoom::most_of_a_source);
}

TEST(WaitingRoom, WhoLeftMakesRoom) {
    WaitingRoom room;
    fill(room, 0, WaitingRoom::early);
    room.leave(3);
    room.leave(3);
    room.leave(1000);
    EXPECT_EQ(room.enter(1000, "late", certainly), std::nullopt);
}

} // namespace
} // namespace framelet
