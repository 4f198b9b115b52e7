// Tests sheets of pictures: what stands where.
#include "tests/evaluation/charts/picture_sheet.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "common/error.h"

namespace framelet::bench {
namespace {

Picture flat(int width, int height, std::uint8_t level) {
    Picture picture(width, height);
    std::ranges::fill(picture.rgba, level);
    return picture;
}

int at(Picture const& picture, int x, int y) {
    return picture.row(y)[4 * x];
}

constexpr int width = 400, height = 200, gap = 6;

int column_left(int column) {
    return gap + column * (width + gap);
}

TEST(PictureSheet, PicturesStandInARowWithTheirErrorsBelow) {
    Picture const reference = flat(width, height, 100);
    Picture off = reference;
    std::fill_n(off.row(0), 4 * width, std::uint8_t(120)); // first row: 20 off
    std::fill_n(off.row(1), 4 * width, std::uint8_t(200)); // second: more than the scale shows
    Picture const sheet = beside_reference(reference, std::vector{reference, off});
    EXPECT_EQ(sheet.width, column_left(3));
    EXPECT_EQ(sheet.height, 3 * gap + 2 * height);
    for (int column = 0; column < 3; ++column) {
        EXPECT_EQ(at(sheet, column_left(column), gap + 5), 100);
        EXPECT_EQ(at(sheet, column_left(column) + width - 1, gap + height - 1), 100);
        EXPECT_EQ(at(sheet, column_left(column) - 1, gap + 5), 255);
    }
    EXPECT_EQ(at(sheet, column_left(2) + 7, gap), 120);
    int const error_top = 2 * gap + height;
    EXPECT_EQ(at(sheet, column_left(1) + 7, error_top), 0);
    EXPECT_EQ(at(sheet, column_left(2) + 7, error_top), 20 * error_gain);
    EXPECT_EQ(at(sheet, column_left(2) + 7, error_top + 1), 255);
    EXPECT_EQ(at(sheet, column_left(2) + 7, error_top + 2), 0);
}

TEST(PictureSheet, RefusesOtherSizesAndNoPicture) {
    EXPECT_THROW(beside_reference(flat(4, 4, 0), std::vector{flat(4, 5, 0)}), InputError);
    EXPECT_THROW(beside_reference(Picture(), {}), InputError);
}

} // namespace
} // namespace framelet::bench
