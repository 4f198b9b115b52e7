#include "tests/uniform_tiling.h"

#include <random>

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(Tiling, CoversEveryPixelOnce) {
    for (Viewport const viewport : {Viewport{1, 1}, {17, 5}, {640, 360}, {333, 777}}) {
        ImagePlane const plane(viewport);
        for (int depth = plane.min_depth(); depth <= plane.max_depth(); ++depth) {
            Tiling const tiling = make_uniform_tiling(plane, depth);
            EXPECT_EQ(tiling.tiles.size(), uniform_tile_count(plane, depth));
            std::vector<int> covered(static_cast<std::size_t>(viewport.width * viewport.height));
            for (Tile const tile : tiling.tiles) {
                EXPECT_TRUE(plane.accepts(tile));
                PixelRect const rect = plane.tile_rect(tile);
                for (int y = rect.top; y < std::min(rect.bottom, viewport.height); ++y) {
                    for (int x = rect.left; x < std::min(rect.right, viewport.width); ++x) {
                        ++covered[static_cast<std::size_t>(y * viewport.width + x)];
                    }
                }
            }
            EXPECT_TRUE(std::all_of(covered.begin(), covered.end(), [](int count) { return count == 1; }));
        }
    }
}

TEST(Tiling, FollowsTheMortonCurve) {
    Tiling const tiling = make_uniform_tiling(ImagePlane({1280, 720}), 7);
    EXPECT_TRUE(std::is_sorted(tiling.tiles.begin(), tiling.tiles.end()));
}

} // namespace
} // namespace framelet
