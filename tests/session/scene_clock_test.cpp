#include "server/session/scene_clock.h"

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
}

TEST(SceneClock, StaysInRange) {
    WallTime const start{};
    SceneClock clock(true, start);
    clock.apply({ClockRequest::speed, {0, false, -100}}, start + 4s);
    EXPECT_EQ(clock.state(start + 4s).speed, -max_clock_speed);
    EXPECT_EQ(clock.state(start + 60s).time, 0) << "backwards ends at 0";
    clock.apply({ClockRequest::time, {-3, false, 1}}, start + 60s);
    EXPECT_EQ(clock.state(start + 60s).time, 0);
}

} // namespace
} // namespace framelet
