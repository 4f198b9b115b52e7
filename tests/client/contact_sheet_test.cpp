#include "client/sheet/contact_sheet.h"

#include <algorithm>
#include <cstdint>

#include <gtest/gtest.h>

#include "client/sheet/sheet_moments.h"

namespace framelet {
namespace {

Picture plain(Viewport size, std::uint8_t grey) {
    Picture out(size.width, size.height);
    for (std::size_t i = 0; i < out.rgba.size(); ++i) {
        out.rgba[i] = i % 4 == 3 ? 255 : grey;
    }
    return out;
}

TEST(ContactSheet, HasTheStillsBelowWhatWasShown) {
    ShownAndStill const pairs[] = {{plain({20, 10}, 10), plain({20, 10}, 20)},
                                   {plain({20, 10}, 30), plain({20, 10}, 40)}};
    Picture const sheet = contact_sheet(pairs);
    EXPECT_EQ(sheet.width, 48);
    EXPECT_EQ(sheet.height, 28);
    EXPECT_EQ(sheet.row(0)[0], 10);
    EXPECT_EQ(sheet.row(9)[4 * 19], 10);
    EXPECT_EQ(sheet.row(9)[4 * 20], 255);
    EXPECT_EQ(sheet.row(10)[0], 255);
    EXPECT_EQ(sheet.row(18)[0], 20);
    EXPECT_EQ(sheet.row(0)[4 * 28], 30);
    EXPECT_EQ(sheet.row(27)[4 * 47], 40);
}

TEST(ContactSheet, BlackAndWhiteDifferByOne) {
    EXPECT_DOUBLE_EQ(mean_difference(plain({4, 4}, 0), plain({4, 4}, 255)), 1);
    EXPECT_DOUBLE_EQ(mean_difference(plain({4, 4}, 51), plain({4, 4}, 0)), 0.2);
    EXPECT_DOUBLE_EQ(mean_difference(plain({4, 4}, 7), plain({4, 4}, 7)), 0);
}

TEST(SheetMoments, AreThreeOfTheRun) {
    SheetMoments moments(4);
    EXPECT_EQ(moments.difference(), -1);
    for (int i = 0; i < 400; ++i) {
        moments.note(0.01 * i, plain({2, 2}, static_cast<std::uint8_t>(i / 2)), {});
    }
    ASSERT_EQ(moments.pairs().size(), 3u);
    EXPECT_EQ(moments.pairs()[0].shown.rgba[0], 50);
    EXPECT_EQ(moments.pairs()[1].shown.rgba[0], 100);
    EXPECT_EQ(moments.pairs()[2].shown.rgba[0], 150);
}

} // namespace
} // namespace framelet
