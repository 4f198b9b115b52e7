#include "server/sampling/field/density_tiling.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "common/morton.h"
#include "tests/uniform_tiling.h"

namespace framelet {
namespace {

constexpr Viewport viewports[] = {{1, 1}, {16, 16}, {17, 5}, {255, 257}, {640, 360}, {1280, 720}, {16384, 100}};

std::vector<float> random_density(ImagePlane const& plane, std::mt19937& random) {
    std::vector<float> density(std::size_t{1} << (2 * field_depth(plane)));
    for (float& value : density) {
        value = random() % 8 == 0 ? 0 : std::exp2(std::uniform_real_distribution<float>(-9, 6)(random));
    }
    return density;
}

/// All tiles of the cut.
Tiling make_density_tiling(ImagePlane const& plane, std::vector<float> const& density) {
    TilingScratch scratch;
    std::vector<Patch> patches;
    make_density_patches(plane, density, field_depth(plane), scratch, patches);
    Tiling tiling{plane, {}};
    for (Patch const& patch : patches) {
        append_tiles(plane, patch, tiling.tiles);
    }
    return tiling;
}

/// Every cell of the finest tiles' size that shows something is covered once.
void expect_covered_once(ImagePlane const& plane, std::vector<Tile> const& tiles) {
    int const cell = plane.side() >> plane.max_depth();
    int const columns = (plane.viewport().width + cell - 1) / cell;
    int const rows = (plane.viewport().height + cell - 1) / cell;
    std::vector<std::uint8_t> covered(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    for (Tile const tile : tiles) {
        ASSERT_TRUE(plane.accepts(tile));
        PixelRect const rect = plane.tile_rect(tile);
        for (int y = rect.top / cell; y < std::min(rect.bottom / cell, rows); ++y) {
            for (int x = rect.left / cell; x < std::min(rect.right / cell, columns); ++x) {
                ++covered[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
                          static_cast<std::size_t>(x)];
            }
        }
    }
    EXPECT_TRUE(std::all_of(covered.begin(), covered.end(), [](auto count) { return count == 1; }))
        << plane.viewport().width << "x" << plane.viewport().height;
}

/// Tile 4, two levels down, is [64, 80).
TEST(DensityTiling, APatchIsAnInterval) {
    ImagePlane const plane({256, 256});
    std::vector<Tile> tiles;
    append_tiles(plane, {Tile{4}, 3}, tiles);
    ASSERT_EQ(tiles.size(), 16u);
    for (std::uint32_t i = 0; i < 16; ++i) {
        EXPECT_EQ(tiles[i].code, 64 + i);
    }
}

TEST(DensityTiling, CoversEveryPixelOnce) {
    std::mt19937 random(1);
    for (Viewport const viewport : viewports) {
        ImagePlane const plane(viewport);
        for (int n = 0; n < 3; ++n) {
            Tiling const tiling = make_density_tiling(plane, random_density(plane, random));
            expect_covered_once(plane, tiling.tiles);
        }
    }
}

TEST(DensityTiling, ATileIsWorthAboutAFramelet) {
    std::mt19937 random(2);
    for (Viewport const viewport : viewports) {
        ImagePlane const plane(viewport);
        int const depth = field_depth(plane);
        auto const density = random_density(plane, random);
        double const element_area = std::ldexp(double(plane.side()) * plane.side(), -2 * depth);
        auto const integral = [&](Tile tile) { // over elements that show something
            if (tile.depth() > depth) {
                std::size_t const element = (tile.code >> (2 * (tile.depth() - depth))) - (1u << (2 * depth));
                return double(density[element]) * std::ldexp(element_area, -2 * (tile.depth() - depth));
            }
            double sum = 0;
            int const shift = 2 * (depth - tile.depth());
            for (std::uint32_t i = 0; i < 1u << shift; ++i) {
                Tile const element{(tile.code << shift) + i};
                sum += plane.is_visible(element) ? double(density[element.index()]) * element_area : 0;
            }
            return sum;
        };
        double const step = 1; // rounding of elements
        for (Tile const tile : make_density_tiling(plane, density).tiles) {
            if (tile.depth() < plane.max_depth()) {
                ASSERT_LE(integral(tile), 2 * framelet_samples + step) << tile.code;
            }
            if (tile.depth() > plane.min_depth()) { // its parent would have been too much
                ASSERT_GT(integral(tile.parent()), 2 * framelet_samples - 4 * step) << tile.code;
            }
        }
    }
}

TEST(DensityTiling, UniformDensityIsTheUniformTiling) {
    for (Viewport const viewport : viewports) {
        ImagePlane const plane(viewport);
        int const depth = field_depth(plane);
        for (int level = plane.min_depth(); level <= std::min(plane.max_depth(), plane.pixel_depth() + 1); ++level) {
            std::vector<float> const density(std::size_t{1} << (2 * depth),
                                             std::ldexp(1.0f, 2 * (level - plane.pixel_depth())));
            Tiling const tiling = make_density_tiling(plane, density);
            Tiling const uniform = make_uniform_tiling(plane, level);
            // A coarse node that reaches out of the viewport is worth less, and may be one tile for four.
            if (viewport.width == plane.side() && viewport.height == plane.side()) {
                EXPECT_EQ(tiling, uniform) << viewport.width << " level " << level;
            }
            if (level > depth) {
                EXPECT_EQ(tiling, uniform) << viewport.width << " level " << level;
            }
        }
    }
}

/// The same integral of density over pictures of 256 and of 4096 pixels.
TEST(DensityTiling, CostDoesNotGrowWithPixels) {
    for (double const framelets : {16.0, 256.0, 4096.0, 65536.0}) {
        for (int const side : {256, 1024, 4096, 16384}) {
            ImagePlane const plane({side, side});
            int const depth = field_depth(plane);
            auto const uniform = static_cast<float>(framelets * framelet_samples / side / side);
            std::vector<float> density(std::size_t{1} << (2 * depth));
            for (std::uint32_t i = 0; i < density.size(); ++i) { // a gradient
                density[i] = uniform * (0.5f + static_cast<float>(morton_x(i)) / static_cast<float>(1 << depth));
            }
            TilingScratch scratch;
            std::vector<Patch> patches;
            make_density_patches(plane, density, depth, scratch, patches);
            double const least = std::ldexp(1.0, 2 * std::min(plane.min_depth(), depth)); // coarsest tiles
            EXPECT_LE(static_cast<double>(patches.size()), 2 * std::max(framelets, least)) << side;
            EXPECT_LE(patches.size(), std::size_t{1} << (2 * most_field_depth));
            EXPECT_EQ(scratch.sums.size(), density.size() + 1);
        }
    }
}

} // namespace
} // namespace framelet
