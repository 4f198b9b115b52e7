#include "client/core/picture/late_clock.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(LateClock, SaysWhatWasReadALagAgo) {
    LateClock clock(0.1);
    EXPECT_EQ(clock.read(5, 20), 20) << "nothing earlier is known";
    EXPECT_EQ(clock.read(5.05, 20.05), 20);
    EXPECT_NEAR(clock.read(5.125, 20.125), 20.025, 1e-9);
    EXPECT_NEAR(clock.read(5.2, 20.2), 20.1, 1e-9);
    // Paused: it arrives, exactly, and stays.
    EXPECT_NEAR(clock.read(5.25, 20.2), 20.15, 1e-9);
    for (double now = 5.3; now < 5.6; now += 0.05) {
        EXPECT_NEAR(clock.read(now + 1e-9, 20.2), 20.2, 1e-9);
    }
    EXPECT_EQ(clock.read(6, 20.2), 20.2);
    // Set back: that shows a lag later.
    EXPECT_EQ(clock.read(6.01, 3), 20.2);
    EXPECT_NEAR(clock.read(6.12, 3.1), 3.01, 1e-2);
}

TEST(LateClock, WithoutALagItIsTheClock) {
    LateClock clock(0);
    EXPECT_EQ(clock.read(1, 7), 7);
    EXPECT_EQ(clock.read(1, 8), 8);
    EXPECT_EQ(clock.read(2, 9), 9);
}

} // namespace
} // namespace framelet
