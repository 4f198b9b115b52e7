#include "client/core/drawn_over/confidence_colors.h"

#include <algorithm>
#include <array>
#include <vector>

#include <gtest/gtest.h>

namespace framelet {
namespace {

std::array<int, 3> color_of(PixelConfidence const& confidence) {
    Picture picture(1, 1);
    std::fill_n(picture.rgba.begin(), 3, std::uint8_t{100});
    std::uint8_t const alpha = picture.rgba[3];
    draw_confidence({&confidence, 1}, picture);
    EXPECT_EQ(picture.rgba[3], alpha);
    return {picture.rgba[0], picture.rgba[1], picture.rgba[2]};
}

int brightness(PixelConfidence const& confidence) {
    auto const [red, green, blue] = color_of(confidence);
    return red + green + blue;
}

TEST(ConfidenceColors, GetDarkerWithAgeAndSpacing) {
    int last = 1000;
    for (float const seconds : {0.0f, 0.1f, 1.0f, 10.0f}) {
        int const now = brightness({seconds, 1});
        EXPECT_LT(now, last) << seconds;
        last = now;
    }
    EXPECT_EQ(brightness({10, 1}), brightness({1e9f, 1}));
    last = 1000;
    for (float const spacing : {1.0f, 2.0f, 4.0f, 8.0f}) {
        int const now = brightness({0.1f, spacing});
        EXPECT_LT(now, last) << spacing;
        last = now;
    }
    EXPECT_EQ(brightness({0.1f, 0.25f}), brightness({0.1f, 1}));
}

TEST(ConfidenceColors, TellWhatIsMadeUp) {
    auto const [red, green, blue] = color_of({});
    EXPECT_GT(std::min(red, blue), 2 * green); // magenta
}

} // namespace
} // namespace framelet
