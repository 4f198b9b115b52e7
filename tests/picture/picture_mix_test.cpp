#include "common/picture/picture_mix.h"

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include "common/warp/warp_block.h"

namespace framelet {
namespace {

constexpr PixelRect everything{0, 0, 256, 256};

/// Every pair of values.
struct Pairs {
    Picture first{256, 256}, second{256, 256};

    Pairs() {
        for (int y = 0; y < 256; ++y) {
            for (int x = 0; x < 256; ++x) {
                std::fill_n(first.row(y) + 4 * x, 3, static_cast<std::uint8_t>(x));
                std::fill_n(second.row(y) + 4 * x, 3, static_cast<std::uint8_t>(y));
                first.row(y)[4 * x + 3] = second.row(y)[4 * x + 3] = 255;
            }
        }
    }
    Picture mixed(MixShare share) const {
        Picture out(256, 256);
        mix_pictures({first, {}}, {second, {}}, share, everything, out);
        return out;
    }
};

TEST(PictureMix, EndsAreThePicturesAndNothingLeavesTheirBounds) {
    Pairs const pairs;
    EXPECT_EQ(pairs.mixed(0), pairs.first);
    EXPECT_EQ(pairs.mixed(whole_share), pairs.second);
    Picture before = pairs.first;
    for (MixShare const share : {1, 77, 128, 200, 255}) {
        Picture const mixed = pairs.mixed(share);
        for (std::size_t i = 0; i < mixed.rgba.size(); ++i) {
            auto const [low, high] = std::minmax(pairs.first.rgba[i], pairs.second.rgba[i]);
            ASSERT_GE(mixed.rgba[i], low);
            ASSERT_LE(mixed.rgba[i], high);
            bool const rises = pairs.second.rgba[i] >= pairs.first.rgba[i];
            ASSERT_TRUE(rises ? mixed.rgba[i] >= before.rgba[i] : mixed.rgba[i] <= before.rgba[i]) << "is monotonic";
        }
        before = mixed;
    }
}

TEST(PictureMix, HalfOfBlackAndWhiteIsHalfOfTheLight) {
    EXPECT_EQ(Pairs().mixed(whole_share / 2).row(255)[0], 180); // 255 / sqrt(2) = 180.3
}

TEST(PictureMix, SharesAreClampedAndRounded) {
    EXPECT_EQ(mix_share(-3), 0);
    EXPECT_EQ(mix_share(0.5), 128);
    EXPECT_EQ(mix_share(1), whole_share);
    EXPECT_EQ(mix_share(std::numeric_limits<double>::infinity()), whole_share);
}

TEST(PictureMix, EqualPicturesStayAsTheyAreAndItSaysSo) {
    Pairs const pairs;
    Picture mixed(256, 256);
    PixelRect const rect{3, 5, 20, 9};
    EXPECT_FALSE(mix_pictures({pairs.first, {}}, {pairs.first, {}}, 100, rect, mixed));
    for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 256; ++x) {
            bool const inside = x >= rect.left && x < rect.right && y >= rect.top && y < rect.bottom;
            ASSERT_EQ(mixed.row(y)[4 * x + 3], inside ? 255 : 0) << "only the rectangle is written";
            ASSERT_EQ(mixed.row(y)[4 * x], inside ? pairs.first.row(y)[4 * x] : 0);
        }
    }
    EXPECT_TRUE(mix_pictures({pairs.first, {}}, {pairs.second, {}}, 100, everything, mixed));
}

TEST(PictureMix, WhereOneHasAHoleTheOtherShows) {
    Picture first(3, 1), second(3, 1);
    std::ranges::fill(first.rgba, std::uint8_t{10});
    std::ranges::fill(second.rgba, std::uint8_t{200});
    std::vector<float> const first_depth{hole_depth, 1, hole_depth};
    std::vector<float> const second_depth{1, hole_depth, hole_depth};
    Picture mixed(3, 1);
    mix_pictures({first, first_depth}, {second, second_depth}, 0, {0, 0, 3, 1}, mixed);
    EXPECT_EQ(mixed.rgba[0], 200);
    EXPECT_EQ(mixed.rgba[4], 10);
    EXPECT_EQ(mixed.rgba[8], 10) << "both: as anywhere";
    mix_pictures({first, {}}, {second, second_depth}, 256, {0, 0, 3, 1}, mixed);
    EXPECT_EQ(mixed.rgba[0], 200);
    EXPECT_EQ(mixed.rgba[4], 10);
    EXPECT_EQ(mixed.rgba[8], 10);
}

} // namespace
} // namespace framelet
