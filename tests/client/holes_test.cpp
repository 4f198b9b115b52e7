#include "client/core/drawn_over/holes.h"

#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "tests/picture/synthetic_framelets.h"

namespace framelet {
namespace {

std::array<int, 3> color_at(Picture const& picture, int x, int y) {
    std::uint8_t const* const pixel = picture.row(y) + 4 * static_cast<std::ptrdiff_t>(x);
    return {pixel[0], pixel[1], pixel[2]};
}

constexpr std::array<int, 3> magenta{255, 0, 255};
constexpr std::array<int, 3> black{0, 0, 0};

TEST(Holes, AreWhatNoPixelIsHeldOf) {
    Picture picture(3, 2);
    std::vector<PixelConfidence> confidence(6, {0.5f, 1});
    confidence[4] = {};
    draw_holes(confidence, picture);
    for (int i = 0; i < 6; ++i) {
        EXPECT_EQ(color_at(picture, i % 3, i / 3), i == 4 ? magenta : black) << i;
    }
}

TEST(Holes, AreWhatNoTileCovers) {
    ImagePlane const plane({200, 120});
    FrameletCache cache(plane);
    cache.insert(make_batch(plane, 1,
                            {constant_framelet(plane, make_tile(plane.pixel_depth() - 1, 0, 0), 9),
                             constant_framelet(plane, make_tile(plane.pixel_depth() + 2, 13, 9), 9)}));
    Picture picture(200, 120);
    draw_holes(cache, picture);
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            bool const is_held = (x < 32 && y < 32) || (x >= 52 && x < 56 && y >= 36 && y < 40);
            ASSERT_EQ(color_at(picture, x, y), is_held ? black : magenta) << x << ' ' << y;
        }
    }
}

} // namespace
} // namespace framelet
