#include "client/window/overlay/time_line.h"

#include <utility>

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(TimeLine, ARoundIsFromOneBeginningOfTheLongestClipToTheNext) {
    auto const round = [](SceneTime time, double duration) {
        TimeLine const line{{time, true, 1}, duration};
        return std::pair(line.round_begin(), line.round_end());
    };
    EXPECT_EQ(round(3, 4), std::pair(0.0, 4.0));
    EXPECT_EQ(round(4, 4), std::pair(4.0, 8.0));
    EXPECT_EQ(round(13.5, 4), std::pair(12.0, 16.0));
    EXPECT_EQ(round(13.5, 0), std::pair(0.0, 0.0)) << "nothing moves";
    EXPECT_EQ(round(max_scene_time, 4).second, max_scene_time);
}

} // namespace
} // namespace framelet
