#include "server/schedule/view_refresh.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

ViewState state_at(SceneTime time) {
    ViewState state;
    state.view.viewport = {100, 70};
    state.scene_time = time;
    return state;
}

TEST(ViewRefresh, ANewViewIsShownWholeAtTheDepthThatIsAffordable) {
    ViewRefresh refresh;
    ImagePlane const plane({100, 70});
    for (double const affordable : {0.0, 3000.0, 1e9}) {
        for (double const time : {0.0, 1.0}) {
            auto const tiles = next_tiles(refresh, state_at(time + affordable), affordable, 0);
            int const depth = deepest_affordable(plane, affordable);
            EXPECT_EQ(tiles, make_uniform_tiling(plane, depth).tiles) << affordable;
        }
    }
}

TEST(ViewRefresh, AnUnchangedViewIsRefinedACycleAtATimeUntilComplete) {
    ViewRefresh refresh;
    ViewState const state = state_at(2);
    EXPECT_FALSE(is_complete(refresh, state));
    next_tiles(refresh, state, 1000, 0);
    std::size_t batches = 0;
    while (!is_complete(refresh, state)) {
        auto const tiles = next_tiles(refresh, state, 1000, 0);
        ASSERT_FALSE(tiles.empty());
        EXPECT_LE(tiles.size(), std::size_t(1000 / framelet_samples + 1));
        ASSERT_LT(++batches, 1000u);
    }
    EXPECT_TRUE(next_tiles(refresh, state, 1000, 0).empty());
    EXPECT_FALSE(is_complete(refresh, state_at(3))) << "something moved";
    ViewState brighter = state;
    brighter.exposure = 2;
    EXPECT_FALSE(is_complete(refresh, brighter));
}

TEST(ViewRefresh, ABatchHoldsNoMoreThanItIsToldTo) {
    ViewRefresh refresh;
    EXPECT_EQ(next_tiles(refresh, state_at(0), 1e9, 5).size(), 5u);
    EXPECT_EQ(next_tiles(refresh, state_at(1), 1e9, 7).size(), 7u);
}

} // namespace
} // namespace framelet
