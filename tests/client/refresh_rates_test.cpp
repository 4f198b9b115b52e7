#include "client/core/drawn_over/refresh_rates.h"

#include <gtest/gtest.h>

#include "tests/picture/synthetic_framelets.h"

namespace framelet {
namespace {

ImagePlane const plane(Viewport{200, 120});

/// The rates after ten seconds in which a framelet of this tile came so often a second.
RefreshRates after(Tile tile, double per_second) {
    RefreshRates rates(plane);
    Batch const batch = make_batch(plane, 1, {constant_framelet(plane, tile, 9)});
    for (int i = 0; i < 10 * per_second; ++i) {
        rates.advance(i / per_second);
        rates.add(batch);
    }
    rates.advance(10);
    return rates;
}

TEST(RefreshRates, AreHowOftenACellIsReplaced) {
    Tile const tile = make_tile(plane.pixel_depth(), 3, 2);
    for (double const rate : {5.0, 20.0, 60.0}) {
        RefreshRates const rates = after(tile, rate);
        EXPECT_NEAR(rates.per_second(3, 2), rate, 0.6) << "it is least just before the next comes";
        EXPECT_EQ(rates.per_second(2, 2), 0);
        EXPECT_EQ(rates.per_second(3, 3), 0);
    }
}

TEST(RefreshRates, ACoarseTileReplacesManyCellsAFineOneAPart) {
    RefreshRates const coarse = after(make_tile(plane.pixel_depth() - 2, 3, 1), 20); // pixels (192, 64) .. (256, 128)
    EXPECT_NEAR(coarse.per_second(12, 4), 20, 0.6);
    EXPECT_NEAR(coarse.per_second(12, 7), 20, 0.6);
    EXPECT_EQ(coarse.per_second(11, 4), 0);
    RefreshRates const fine = after(make_tile(plane.pixel_depth() + 2, 13, 9), 32); // pixels (52, 36) .. (56, 40)
    EXPECT_NEAR(fine.per_second(3, 2), 2, 0.1);
}

TEST(RefreshRates, FadeOnceNothingComes) {
    RefreshRates rates = after(make_tile(plane.pixel_depth(), 0, 0), 20);
    EXPECT_TRUE(rates.fades());
    rates.advance(11);
    EXPECT_NEAR(rates.per_second(0, 0), 20 / 2.718, 0.6);
    rates.advance(5); // a clock that goes back changes nothing
    EXPECT_NEAR(rates.per_second(0, 0), 20 / 2.718, 0.6);
    rates.advance(30);
    EXPECT_FALSE(rates.fades());
}

TEST(RefreshRates, ColoursAreBrightWhereMuchComes) {
    int last = 1000;
    for (double const rate : {60.0, 10.0, 1.0}) {
        Picture picture(200, 120);
        after(make_tile(plane.pixel_depth(), 3, 2), rate).draw(picture);
        std::uint8_t const* const pixel = picture.row(40) + std::ptrdiff_t{4} * 50;
        int const brightness = pixel[0] + pixel[1] + pixel[2];
        EXPECT_LT(brightness, last) << rate;
        EXPECT_GT(brightness, 0) << rate;
        last = brightness;
        EXPECT_EQ(picture.row(40)[4 * 47], 0) << "the next cell is black, as it was";
        EXPECT_EQ(picture.row(48)[4 * 50], 0);
    }
}

} // namespace
} // namespace framelet
