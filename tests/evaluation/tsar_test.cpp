// Tests the method `tsar`: where it samples, when, and how its viewer blends framelets of different ages.
#include <numeric>

#include <gtest/gtest.h>

#include "tests/evaluation/methods/tsar.h"

namespace framelet::bench {
namespace {

ImagePlane const plane({64, 64}); // tiles of depth 2 have a sample a pixel

double area_of(Tiling const& tiling) {
    double area = 0;
    for (Tile const tile : tiling.tiles) {
        double const side = tiling.plane.tile_side(tile);
        area += side * side;
    }
    return area;
}

TEST(TsarSchedule, TilesFollowTheDensity) {
    std::vector<double> density(256, 1.0);
    auto const uniform = make_density_tiling(plane, density, 4, 2 * framelet_samples);
    EXPECT_EQ(uniform, make_uniform_tiling(plane, 2));
    // The first quarter needs 16 samples a pixel, the last next to none.
    std::fill_n(density.begin(), 64, 16.0);
    std::fill_n(density.end() - 64, 64, 1.0 / 64);
    auto const tiling = make_density_tiling(plane, density, 4, 2 * framelet_samples);
    EXPECT_EQ(area_of(tiling), 64 * 64);
    EXPECT_EQ(tiling.tiles.size(), 64u + 4 + 4 + 1);
    EXPECT_EQ(tiling.tiles.front().depth(), 4);
    EXPECT_EQ(tiling.tiles.back().depth(), 1);
    // The elements may be coarser than the finest tiles.
    EXPECT_EQ(make_density_tiling(plane, std::vector<double>(1, 16.0), 0, 2 * framelet_samples),
              make_uniform_tiling(plane, 4));
}

TEST(TsarSchedule, TilesOutsideTheViewportAreLeftOut) {
    ImagePlane const narrow({64, 20});
    auto const tiling = make_density_tiling(narrow, std::vector<double>(256, 1.0), 4, 2 * framelet_samples);
    EXPECT_EQ(tiling, make_uniform_tiling(narrow, 2));
}

TEST(TsarSchedule, EveryTileComesAtItsOwnRate) {
    auto const tiles = make_uniform_tiling(plane, 2).tiles;
    DensityField density = make_uniform_density(2, {1, 4});
    std::fill_n(density.time.begin(), 4, 20.0);
    std::vector<double> refreshed(16, 0.0);
    std::vector<int> times(16);
    constexpr int cycles = 1600;
    for (int cycle = 1; cycle <= cycles; ++cycle) {
        double const now = cycle / 64.0; // two tiles in each cycle: all tiles together ask for 128 a second
        auto const chosen = select_overdue(tiles, density, refreshed, now, 2);
        ASSERT_EQ(chosen.size(), 2u);
        for (std::size_t const i : chosen) {
            ++times[i];
            refreshed[i] = now;
        }
    }
    for (std::size_t i = 0; i < times.size(); ++i) {
        EXPECT_NEAR(times[i], cycles / 64.0 * (i < 4 ? 20 : 4), i < 4 ? 50 : 10) << i;
    }
    EXPECT_EQ(select_overdue(tiles, density, refreshed, 100, 99).size(), 16u);
}

std::vector<DisplayFramelet> uniform_picture(int depth, std::uint8_t level) {
    std::vector<DisplayFramelet> framelets;
    for (Tile const tile : make_uniform_tiling(plane, depth).tiles) {
        DisplayFramelet& framelet = framelets.emplace_back();
        framelet.tile = tile;
        framelet.red.fill(level);
        framelet.green.fill(level);
        framelet.blue.fill(level);
    }
    return framelets;
}

TEST(TsarViewer, OneColourStaysThatColourAtEveryDepth) {
    for (int depth = plane.min_depth(); depth <= plane.max_depth(); ++depth) {
        TsarViewer viewer(plane);
        viewer.show(uniform_picture(depth, 90), 0, 0);
        for (std::size_t i = 0; i < viewer.picture().rgba.size(); ++i) {
            ASSERT_EQ(viewer.picture().rgba[i], i % 4 == 3 ? 255 : 90) << depth << ' ' << i;
        }
    }
}

TEST(TsarViewer, OneSampleAPixelIsShownAsItIs) {
    TsarViewer viewer(plane);
    auto framelets = uniform_picture(2, 0);
    for (DisplayFramelet& framelet : framelets) {
        std::iota(framelet.red.begin(), framelet.red.end(), std::uint8_t(0));
    }
    viewer.show(framelets, 0, 0);
    for (std::uint32_t y = 0; y < 64; ++y) {
        for (std::uint32_t x = 0; x < 64; ++x) {
            ASSERT_EQ(viewer.picture().row(static_cast<int>(y))[4 * x], morton_index(x % 16, y % 16));
        }
    }
}

TEST(TsarViewer, NewerFrameletsReplaceOlderOnes) {
    TsarViewer viewer(plane);
    for (int step = 0; step < 4; ++step) {
        viewer.show(uniform_picture(2, static_cast<std::uint8_t>(50 * step)), step, step);
        EXPECT_EQ(viewer.framelet_count(), 16u) << "what is hidden everywhere is dropped";
        EXPECT_EQ(viewer.picture().rgba[0], 50 * step);
        EXPECT_DOUBLE_EQ(viewer.mean_scene_time(), step);
    }
}

TEST(TsarViewer, OlderFrameletsShowThroughNearANeighbourThatIsOlderStill) {
    TsarViewer viewer(plane);
    auto const all = uniform_picture(2, 0);
    viewer.show(all, 0, 0);
    // Only the tile at the left upper corner is refreshed, ten times, brighter and brighter.
    for (int step = 1; step <= 10; ++step) {
        auto one = uniform_picture(2, static_cast<std::uint8_t>(20 * step));
        one.resize(1);
        viewer.show(one, step, step);
    }
    EXPECT_GT(viewer.framelet_count(), 17u);
    auto const level = [&](int x) { return viewer.picture().row(4)[4 * x]; };
    EXPECT_LT(level(15), 200) << "blended with older ones at the border of ages";
    EXPECT_GT(level(15), 20);
    EXPECT_GE(level(0), level(15));
    EXPECT_EQ(level(20), 0) << "the older side stays";
}

} // namespace
} // namespace framelet::bench
