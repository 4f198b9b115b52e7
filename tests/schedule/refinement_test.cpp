#include "server/schedule/refinement.h"

#include <map>
#include <set>

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(Refinement, RefreshesEveryTileOnceADepthFromCoarseToFine) {
    ImagePlane const plane({100, 70});
    for (std::size_t const limit : {1u, 7u, 1000u}) {
        Refinement refinement = start_refinement(plane, plane.min_depth());
        std::map<int, std::set<Tile>> seen;
        int last_depth = plane.min_depth();
        for (;;) {
            bool const converged = is_converged(refinement);
            auto const tiles = select_tiles(refinement, limit);
            EXPECT_EQ(converged, tiles.empty());
            if (tiles.empty()) {
                break;
            }
            EXPECT_LE(tiles.size(), limit);
            for (Tile const tile : tiles) {
                EXPECT_EQ(tile.depth(), tiles.front().depth());
                EXPECT_TRUE(seen[tile.depth()].insert(tile).second) << "refreshed twice";
            }
            EXPECT_GE(tiles.front().depth(), last_depth);
            last_depth = tiles.front().depth();
        }
        for (int depth = plane.min_depth(); depth <= plane.max_depth(); ++depth) {
            EXPECT_EQ(seen[depth].size(), uniform_tile_count(plane, depth));
        }
    }
}

TEST(Refinement, StaysConverged) {
    ImagePlane const plane({16, 16});
    Refinement refinement = start_refinement(plane, plane.max_depth());
    EXPECT_EQ(select_tiles(refinement, 100).size(), 16u);
    EXPECT_TRUE(select_tiles(refinement, 100).empty());
    EXPECT_TRUE(select_tiles(refinement, 100).empty());
}

} // namespace
} // namespace framelet
