#include "common/framelet/tile.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(Tile, VectorsOfTheSource) {
    // [Stephens 2011] section 4.1: (x=3, y=2) on a 4x4 grid is index 13, tile 29.
    EXPECT_EQ(morton_index(3, 2), 13u);
    EXPECT_EQ(make_tile(2, 3, 2).code, 29u);
    // Tile 4, two levels down, is [64, 80).
    Tile const tile{4};
    EXPECT_EQ(tile.child(0).child(0).code, 64u);
    EXPECT_EQ(tile.child(3).child(3).code, 79u);
}

TEST(Tile, CodeAndPlaceAreInverse) {
    for (int depth = 0; depth <= 12; ++depth) {
        std::uint32_t const side = 1u << depth;
        for (std::uint32_t step = 0; step < 64; ++step) {
            std::uint32_t const x = (step * 2654435761u) % side;
            std::uint32_t const y = (step * 40503u + 7) % side;
            Tile const tile = make_tile(depth, x, y);
            EXPECT_EQ(tile.depth(), depth);
            EXPECT_EQ(tile.column(), x);
            EXPECT_EQ(tile.row(), y);
            EXPECT_TRUE(is_tile_code(tile.code));
            if (depth > 0) {
                EXPECT_EQ(tile.parent(), make_tile(depth - 1, x / 2, y / 2));
            }
        }
    }
    EXPECT_FALSE(is_tile_code(0));
    EXPECT_FALSE(is_tile_code(2));
    EXPECT_FALSE(is_tile_code(3));
    EXPECT_FALSE(is_tile_code(8));
}

TEST(ImagePlane, IsTheSmallestSquareThatCovers) {
    EXPECT_EQ(ImagePlane({1, 1}).side(), 16);
    EXPECT_EQ(ImagePlane({16, 16}).side(), 16);
    EXPECT_EQ(ImagePlane({17, 1}).side(), 32);
    EXPECT_EQ(ImagePlane({1280, 720}).side(), 2048);
    EXPECT_EQ(ImagePlane({720, 1280}).pixel_depth(), 7);
    EXPECT_EQ(ImagePlane({max_viewport_side, 1}).side(), max_viewport_side);
}

TEST(ImagePlane, TilesOutsideTheViewportAreNotAccepted) {
    ImagePlane const plane({1280, 720});
    Tile const last = make_tile(7, 1279 / 16, 719 / 16);
    EXPECT_TRUE(plane.accepts(last));
    EXPECT_FALSE(plane.accepts(make_tile(7, last.column() + 1, 0)));
    EXPECT_FALSE(plane.accepts(make_tile(7, 0, last.row() + 1)));
    EXPECT_FALSE(plane.accepts(Tile{1})) << "coarser than allowed";
    EXPECT_FALSE(plane.accepts(make_tile(10, 0, 0))) << "finer than allowed";
    EXPECT_FALSE(plane.accepts(Tile{0}));
}

TEST(ImagePlane, SpacingFollowsDepth) {
    ImagePlane const plane({1280, 720});
    EXPECT_FLOAT_EQ(plane.sample_spacing(make_tile(4, 0, 0)), 8.0f);
    EXPECT_FLOAT_EQ(plane.sample_spacing(make_tile(7, 0, 0)), 1.0f);
    EXPECT_FLOAT_EQ(plane.sample_spacing(make_tile(9, 0, 0)), 0.25f);
    EXPECT_EQ(plane.tile_rect(make_tile(9, 3, 5)), (PixelRect{12, 20, 16, 24}));
}

} // namespace
} // namespace framelet
