#include "client/core/drawn_over/framelet_outlines.h"

#include <gtest/gtest.h>

#include "tests/picture/synthetic_framelets.h"

namespace framelet {
namespace {

int brightness(Picture const& picture, int x, int y) {
    std::uint8_t const* const pixel = picture.row(y) + 4 * static_cast<std::ptrdiff_t>(x);
    return pixel[0] + pixel[1] + pixel[2];
}

TEST(FrameletOutlines, LieOnTheTilesThatAreHeld) {
    ImagePlane const plane({200, 120});
    FrameletCache cache(plane);
    Tile const tile = make_tile(plane.pixel_depth(), 3, 2); // pixels (48, 32) .. (64, 48)
    cache.insert(make_batch(plane, 1, {constant_framelet(plane, tile, 9)}));
    Picture picture(200, 120);
    draw_outlines(cache, picture);
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            bool const edge = (x == 48 && y >= 32 && y < 48) || (y == 32 && x >= 48 && x < 64);
            ASSERT_EQ(brightness(picture, x, y) > 0, edge) << x << ' ' << y;
        }
    }
}

TEST(FrameletOutlines, FreshOnesAreBright) {
    ImagePlane const plane({200, 120});
    FrameletCache cache(plane);
    int last = 1000;
    std::uint32_t column = 0;
    for (std::uint64_t const batch : {1000u, 999u, 900u, 100u}) {
        Tile const tile = make_tile(plane.pixel_depth(), column++, 0);
        cache.insert(make_batch(plane, batch, {constant_framelet(plane, tile, 9)}));
    }
    Picture picture(200, 120);
    draw_outlines(cache, picture);
    for (int i = 0; i < 4; ++i) {
        EXPECT_LT(brightness(picture, 16 * i + 8, 0), last);
        last = brightness(picture, 16 * i + 8, 0);
    }
    EXPECT_GT(last, 0);
}

TEST(FrameletOutlines, AnEmptyCacheLeavesThePicture) {
    Picture picture(64, 48);
    Picture const before = picture;
    draw_outlines(FrameletCache(ImagePlane({64, 48})), picture);
    EXPECT_EQ(picture, before);
}

TEST(FrameletOutlines, ArrivalsAreThoseOfTheNewestBatch) {
    ImagePlane const plane({200, 120});
    FrameletPool pool(plane);
    Picture picture(200, 120);
    draw_arrivals(pool, picture);
    EXPECT_EQ(picture, Picture(200, 120)) << "there are none yet";
    Tile const older = make_tile(plane.pixel_depth(), 0, 0);
    Tile const newer = make_tile(plane.pixel_depth(), 3, 2); // pixels (48, 32) .. (64, 48)
    pool.insert(make_batch(plane, 7, {constant_framelet(plane, older, 9)}), {});
    pool.insert(make_batch(plane, 8, {constant_framelet(plane, newer, 9)}), {});
    draw_arrivals(pool, picture);
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            bool const is_inside = x >= 48 && x < 64 && y >= 32 && y < 48;
            bool const is_edge = is_inside && (x == 48 || x == 63 || y == 32 || y == 47);
            ASSERT_EQ(brightness(picture, x, y) > 0, is_edge) << x << ' ' << y;
        }
    }
    int const edge = brightness(picture, 56, 32);
    EXPECT_EQ(brightness(picture, 48, 32), edge);
    EXPECT_EQ(brightness(picture, 63, 47), edge) << "no pixel is drawn twice";
}

} // namespace
} // namespace framelet
