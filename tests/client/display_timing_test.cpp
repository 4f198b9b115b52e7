#include "client/core/picture/display_timing.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

using Clock = DisplayTiming::Clock;

class DisplayTimingTest : public testing::Test {
protected:
    Clock::time_point at(double seconds) const { return start + DisplayTiming::duration(seconds); }

    Clock::time_point const start{std::chrono::seconds(100)};
    DisplayTiming timing{start, 50};
};

TEST_F(DisplayTimingTest, APictureIsBegunSoThatItIsReadyWhenItIsDue) {
    EXPECT_EQ(timing.begin(0.005), at(-0.005));
    EXPECT_EQ(timing.show(at(0), 0.005), at(0.005)) << "it was begun late";
    EXPECT_FALSE(timing.note_shown(at(0.005)));
    EXPECT_EQ(timing.begin(0.005), at(0.015));
    EXPECT_EQ(timing.show(at(0.015), 0.005), at(0.02));
}

TEST_F(DisplayTimingTest, OneLatePictureDoesNotMoveThoseAfterIt) {
    EXPECT_FALSE(timing.note_shown(at(0.035)));
    EXPECT_FALSE(timing.note_shown(at(0.041)));
    EXPECT_EQ(timing.begin(0), at(0.04));
    EXPECT_FALSE(timing.note_shown(at(0.045)));
    EXPECT_EQ(timing.begin(0), at(0.06));
}

TEST_F(DisplayTimingTest, WhatCannotBeCaughtUpWithIsNotHurriedAfter) {
    EXPECT_TRUE(timing.note_shown(at(0.5)));
    EXPECT_EQ(timing.show(at(0.5), 0.03), at(0.53));
    EXPECT_FALSE(timing.note_shown(at(0.53)));
    EXPECT_EQ(timing.begin(0), at(0.52));
}

} // namespace
} // namespace framelet
