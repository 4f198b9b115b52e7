#include "server/scene/assimp/picture_ops.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

Picture filled(int width, int height, std::array<std::uint8_t, 4> const& color) {
    Picture picture(width, height);
    for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
        picture.rgba[i] = color[i % 4];
    }
    return picture;
}

TEST(PictureOps, OpacityComesFromAlphaOrBrightness) {
    Picture const red = filled(4, 2, {255, 0, 0, 255});
    Picture grey(2, 1);
    grey.rgba = {0, 0, 0, 255, 200, 200, 200, 255};
    Picture const cut = with_opacity(&red, grey);
    ASSERT_EQ(cut.width, 4);
    EXPECT_EQ(cut.rgba[0 * 4 + 3], 0);
    EXPECT_EQ(cut.rgba[1 * 4 + 3], 0);
    EXPECT_EQ(cut.rgba[2 * 4 + 3], 200);
    EXPECT_EQ(cut.rgba[2 * 4], 255) << "colour is kept";
    Picture alpha = grey;
    alpha.rgba[3] = 77;
    EXPECT_EQ(with_opacity(&red, alpha).rgba[3], 77);
    EXPECT_EQ(with_opacity(nullptr, grey).rgba[4], 255) << "white without a colour";
}

TEST(PictureOps, CutoutsHaveHardlyAnythingBetween) {
    Picture picture = filled(10, 10, {0, 0, 0, 255});
    for (std::size_t i = 0; i < 50; ++i) {
        picture.rgba[i * 4 + 3] = 0;
    }
    EXPECT_TRUE(is_cutout(picture));
    for (std::size_t i = 0; i < 20; ++i) {
        picture.rgba[i * 4 + 3] = 128;
    }
    EXPECT_FALSE(is_cutout(picture));
}

TEST(PictureOps, NormalMapsAreBlue) {
    EXPECT_TRUE(is_normal_map(filled(2, 2, {128, 128, 255, 255})));
    EXPECT_FALSE(is_normal_map(filled(2, 2, {128, 128, 128, 255})));
}

} // namespace
} // namespace framelet
