#include "tests/evaluation/charts/side_by_side.h"

#include <algorithm>
#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "common/error.h"

namespace framelet::bench {
namespace {

Picture flat(int width, int height, std::uint8_t level) {
    Picture picture(width, height);
    for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
        picture.rgba[i] = i % 4 == 3 ? std::uint8_t(255) : level;
    }
    return picture;
}

using Rgb = std::array<int, 3>;

Rgb at(Picture const& picture, int x, int y) {
    std::uint8_t const* const p = picture.row(y) + static_cast<std::ptrdiff_t>(x) * 4;
    return {p[0], p[1], p[2]};
}

/// With pictures wide enough for every label: letters of 20, a gap of 10.
constexpr int width = 400, height = 200, gap = 10, line = 30;
constexpr int top = gap + line, error_top = top + height + gap;

int column_left(int column) {
    return gap + column * (width + gap);
}

TEST(SideBySide, PicturesStandInARowWithTheirErrorsBelow) {
    Picture const reference = flat(width, height, 100);
    Picture off = flat(width, height, 100);
    std::fill_n(off.row(0), 4 * width, std::uint8_t(120)); // first row: 20 off
    std::fill_n(off.row(1), 4 * width, std::uint8_t(200)); // second: more than the scale shows
    std::vector<Labelled> const shown{{"same", reference}, {"off", off}};
    Picture const sheet = side_by_side(reference, shown);

    EXPECT_EQ(sheet.width, column_left(3));
    EXPECT_EQ(sheet.height, error_top + height + gap);
    for (int column = 0; column < 3; ++column) {
        EXPECT_EQ(at(sheet, column_left(column), top + 5), (Rgb{100, 100, 100}));
        EXPECT_EQ(at(sheet, column_left(column) + width - 1, top + height - 1), (Rgb{100, 100, 100}));
        EXPECT_EQ(at(sheet, column_left(column) - 1, top + 5), (Rgb{255, 255, 255}));
    }
    EXPECT_EQ(at(sheet, column_left(2) + 7, top), (Rgb{120, 120, 120}));

    Rgb const none = at(sheet, column_left(1) + 7, error_top);
    Rgb const some = at(sheet, column_left(2) + 7, error_top);
    Rgb const most = at(sheet, column_left(2) + 7, error_top + 1);
    EXPECT_LT(none[0] + none[1] + none[2], 10);
    EXPECT_EQ(at(sheet, column_left(2) + 7, error_top + 2), none);
    EXPECT_GT(some[0], none[0] + 50);
    EXPECT_GT(some[0], some[1] + 40); // inferno is purple to red below its middle
    EXPECT_GT(most[0] + most[1] + most[2], 600);
}

TEST(SideBySide, LabelsAreDrawnAboveEachPicture) {
    Picture const reference = flat(width, height, 100);
    std::vector<Labelled> const shown{{"framed+warp, MSE 1e-3", reference}, {"", reference}, {" ", reference}};
    Picture const sheet = side_by_side(reference, shown);
    auto const ink = [&](int column) {
        int dark = 0;
        for (int y = 0; y < top; ++y) {
            for (int x = 0; x < width; ++x) {
                dark += at(sheet, column_left(column) + x, y)[0] < 128 ? 1 : 0;
            }
        }
        return dark;
    };
    EXPECT_GT(ink(0), 200);
    EXPECT_GT(ink(1), ink(0));
    EXPECT_EQ(ink(2), 0);
    EXPECT_EQ(ink(3), 0);
}

TEST(SideBySide, NarrowPicturesGetColumnsAsWideAsTheirLabels) {
    Picture const reference = flat(3, 2, 50);
    std::vector<Labelled> const shown{{"a label that is far wider than the picture", reference}};
    Picture const sheet = side_by_side(reference, shown);
    EXPECT_GT(sheet.width, 2 * 250);
    for (int x = sheet.width - 4; x < sheet.width; ++x) {
        for (int y = 0; y < sheet.height; ++y) {
            EXPECT_EQ(at(sheet, x, y), (Rgb{255, 255, 255})) << "a letter was cut at " << x;
        }
    }
}

TEST(SideBySide, TheReferenceAloneIsAPictureToo) {
    EXPECT_EQ(side_by_side(flat(width, height, 9), {}).width, column_left(1));
}

TEST(SideBySide, RefusesOtherSizesAndNoReference) {
    std::vector<Labelled> const shown{{"other", flat(4, 5, 0)}};
    EXPECT_THROW(side_by_side(flat(4, 4, 0), shown), InputError);
    EXPECT_THROW(side_by_side(Picture(), {}), InputError);
}

} // namespace
} // namespace framelet::bench
