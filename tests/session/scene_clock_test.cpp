#include "server/session/clock/scene_clock.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

using namespace std::chrono_literals;

TEST(SceneClock, RunsStandsAndSeeks) {
    WallTime const start{};
    SceneClock clock(true, start);
    EXPECT_DOUBLE_EQ(clock.state(start + 2s).time, 2);

    clock.apply({ClockRequest::playing, {99, false, 5}}, start + 2s);
    EXPECT_DOUBLE_EQ(clock.state(start + 10s).time, 2) << "only the field that is set is taken";
    EXPECT_EQ(clock.state(start + 10s).speed, 1);

    clock.apply({ClockRequest::time | ClockRequest::playing | ClockRequest::speed, {5, true, 2}}, start + 10s);
    EXPECT_DOUBLE_EQ(clock.state(start + 13s).time, 11);
    EXPECT_DOUBLE_EQ(clock.state(start + 9s).time, 5) << "for who asks late of a moment before";
}

TEST(SceneClock, StaysInRange) {
    WallTime const start{};
    SceneClock clock(true, start);
    clock.apply({ClockRequest::speed, {0, false, -100}}, start + 4s);
    EXPECT_EQ(clock.state(start + 4s).speed, -max_clock_speed);
    EXPECT_EQ(clock.state(start + 60s).time, 0) << "backwards ends at 0";
    clock.apply({ClockRequest::time, {-3, false, 1}}, start + 60s);
    EXPECT_EQ(clock.state(start + 60s).time, 0);
    clock.apply({ClockRequest::time | ClockRequest::speed, {8e16, false, 1}}, start + 60s);
    EXPECT_EQ(clock.state(start + 60s).time, max_scene_time);
}

TEST(SceneClock, EndsAtTheLastMomentHoweverFastAndLong) {
    WallTime const start{};
    SceneClock clock(true, start);
    clock.apply({ClockRequest::speed, {0, true, max_clock_speed}}, start);
    constexpr std::chrono::hours year(365 * 24);
    EXPECT_LT(clock.state(start + year).time, max_scene_time);
    EXPECT_EQ(clock.state(start + 100 * year).time, max_scene_time);
    clock.apply({ClockRequest::speed, {0, true, -1}}, start + 100 * year);
    EXPECT_EQ(clock.state(start + 100 * year + 5s).time, max_scene_time - 5) << "and goes back from there";
}

} // namespace
} // namespace framelet
