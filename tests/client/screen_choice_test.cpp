#include "client/window/screen_choice.h"

#include <array>

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(ScreenChoice, IsTheOneWithMostOfTheWindow) {
    constexpr std::array<PixelRect, 2> screens{PixelRect{0, 0, 1920, 1080}, PixelRect{1920, 0, 4480, 1440}};
    EXPECT_EQ(screen_of({100, 100, 1380, 820}, screens), 0u);
    EXPECT_EQ(screen_of({2000, 100, 3280, 820}, screens), 1u);
    EXPECT_EQ(screen_of({1200, 100, 2480, 820}, screens), 0u); // 720 of 1280 columns
    EXPECT_EQ(screen_of({1500, 100, 2780, 820}, screens), 1u);
    EXPECT_EQ(screen_of({-5000, 0, -4000, 800}, screens), 0u);
    EXPECT_EQ(screen_of({0, 0, 1, 1}, {}), 0u);
}

} // namespace
} // namespace framelet
