#include "client/window/overlay/time_line.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(TimeLine, AnimationsBeginAnewAtTheirEnd) {
    EXPECT_DOUBLE_EQ((TimeLine{{3, true, 1}, 4}.place()), 3);
    EXPECT_DOUBLE_EQ((TimeLine{{4, true, 1}, 4}.place()), 0);
    EXPECT_DOUBLE_EQ((TimeLine{{13.5, true, 1}, 4}.place()), 1.5);
    EXPECT_EQ((TimeLine{{13.5, true, 1}, 0}.place()), 0) << "nothing moves";
}

TEST(TimeLine, SeekingStaysInTheRound) {
    TimeLine const line{{13.5, true, 1}, 4};
    EXPECT_DOUBLE_EQ(line.time_at(0), 12);
    EXPECT_DOUBLE_EQ(line.time_at(3.25), 15.25);
    EXPECT_DOUBLE_EQ(line.time_at(line.place()), line.clock.time);
    TimeLine const last{{max_scene_time, false, 1}, 4};
    EXPECT_LE(last.time_at(3.9), max_scene_time);
}

} // namespace
} // namespace framelet
