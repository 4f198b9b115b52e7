#include "common/warp/merging/merged_square.h"

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "tests/picture/moved_room.h"

namespace framelet {
namespace {

Tile square_over(Tile tile) {
    return {tile.code >> 2 * std::min(tile.depth(), MergedSquare::most_levels)};
}

void expect_same(MergedSquare const& kept, MergedSquare const& fresh) {
    std::size_t const held = static_cast<std::size_t>(std::ranges::count_if(
        kept.children(), [](MergedSquare::Child const& child) { return child.framelet != nullptr; }));
    if (held == 0) {
        EXPECT_TRUE(kept.merged().empty());
        EXPECT_TRUE(fresh.children().empty());
        return;
    }
    ASSERT_EQ(kept.children().size(), fresh.children().size());
    for (std::size_t i = 0; i < kept.children().size(); ++i) {
        EXPECT_EQ(kept.children()[i].framelet, fresh.children()[i].framelet);
        EXPECT_EQ(kept.children()[i].numbers, fresh.children()[i].numbers);
    }
    EXPECT_EQ(kept.children_with_outliers(), fresh.children_with_outliers());
    ASSERT_EQ(kept.merged().size(), fresh.merged().size());
    for (std::size_t i = 0; i < kept.merged().size(); ++i) {
        MergedLayer const& a = kept.merged()[i];
        MergedLayer const& b = fresh.merged()[i];
        EXPECT_EQ(a.tile, b.tile);
        EXPECT_EQ(a.first, b.first);
        EXPECT_EQ(a.first_layer, b.first_layer);
        EXPECT_EQ(a.view, b.view);
        EXPECT_EQ(a.layer.layer, b.layer.layer);
        EXPECT_EQ(a.difference, b.difference);
        EXPECT_EQ(a.number, b.number);
        EXPECT_EQ(a.newest_batch, b.newest_batch);
        EXPECT_EQ(a.signature, b.signature);
        EXPECT_EQ(a.parts, b.parts);
        for (int y = 0; y < a.side; ++y) {
            EXPECT_TRUE(std::equal(a.grid + y * a.stride, a.grid + y * a.stride + a.side, b.grid + y * b.stride));
        }
    }
}

/// Framelets come and go, of two views, with velocities of their own, coarse ones over fine ones too, on the floor, the
/// wall and the board.
TEST(MergedSquare, WhatIsKeptIsWhatIsThere) {
    ImagePlane const plane(viewport);
    AnalyticScene const scene = room();
    std::mt19937 random(5);
    FrameletCache cache(plane);
    Tile const parent = make_tile(plane.pixel_depth() - 1, 4, 3);
    std::map<std::pair<std::uint32_t, int>, MergedSquare> kept;
    CoplanarMerging merging;
    std::size_t found = 0;
    for (std::uint64_t number = 1; number < 300; ++number) {
        std::vector<Tile> tiles;
        int const depth = plane.pixel_depth() - 1 + static_cast<int>(random() % 4);
        int const levels = depth - parent.depth();
        if (random() % 3 == 0) {
            for (std::uint32_t i = 0; i < 1u << 2 * levels; ++i) {
                tiles.push_back({(parent.code << 2 * levels) + i});
            }
        } else {
            tiles.push_back({(parent.code << 2 * levels) + static_cast<std::uint32_t>(random()) % (1u << 2 * levels)});
        }
        Batch batch = scene.batch(plane, number, front(), 0, tiles, random() % 8 == 0);
        batch.view.number = random() % 16 == 0 ? 2 : 1;
        if (number > 100) { // what deforms, differently everywhere: more motions than a square numbers
            for (FrameletShape& shape : batch.shapes) {
                shape.layers[0].drift.corner.velocity.x = static_cast<float>(random() % 10000);
            }
        }
        cache.insert(batch);
        for (int d = plane.min_depth(); d <= plane.max_depth(); ++d) {
            int const down = d - parent.depth();
            Tile const square = square_over(down >= 0 ? Tile{parent.code << 2 * down} : Tile{parent.code >> -2 * down});
            MergedSquare fresh;
            MergedSquare& own = kept[{square.code, d}];
            fresh.update(cache, square, d, merging);
            own.update(cache, square, d, merging);
            found += own.merged().size();
            expect_same(own, fresh);
        }
    }
    EXPECT_GT(found, 300u);
}

/// Framelets of a plane are merged to that one plane, seen at the square's corner.
TEST(MergedSquare, OnePlaneIsFound) {
    ImagePlane const plane(viewport);
    AnalyticScene scene;
    scene.quads.push_back({{-8, -8, -3}, {16, 0, 4}, {0, 16, 0}, waves(12, 6)});
    CoplanarMerging merging;
    for (int levels = -1; levels <= finest_levels; ++levels) {
        FrameletPool const pool = filled(scene, front(), levels);
        FrameletCache const& cache = pool.newest();
        int const depth = plane.pixel_depth() + levels;
        MergedSquare square;
        square.update(cache, make_tile(depth - MergedSquare::most_levels, 0, 0), depth, merging);
        ASSERT_FALSE(square.merged().empty());
        MergedLayer const& merged = square.merged()[0];
        EXPECT_EQ(merged.side, std::min(8 * plane.tile_side(make_tile(depth, 0, 0)), 128));
        Layer const& first = cache.find(depth, 0, 0)->shape.layers[0].layer;
        EXPECT_NEAR(merged.layer.layer.at, first.at, 1e-5 * first.at);
        EXPECT_NEAR(merged.layer.layer.dx, first.dx, 1e-5 * first.at);
        EXPECT_LT(merged.difference, 1e-5f * first.at);
        EXPECT_EQ(square.merged().size(), 1u);
    }
}

/// Every sample of the grid has a number that stands for its own layer or what that is merged with, and no other one's.
TEST(MergedSquare, SamplesHaveTheNumberOfTheirLayer) {
    ImagePlane const plane(viewport);
    AnalyticScene scene = room();
    for (int i = 0; i < 6; ++i) { // more planes than layers in some framelets
        scene.quads.push_back({{0.2 + 0.04 * i, 1, 2 + 0.1 * i}, {0.04, 0, 0}, {0, 0.3, 0.1}, waves(2, 2)});
    }
    scene.quads[2].body = 3;
    CoplanarMerging merging;
    int together = 0, alone = 0, outliers = 0, quads = 0;
    for (int levels = 0; levels <= finest_levels; ++levels) {
        FrameletPool const pool = filled(scene, front(), levels);
        FrameletCache const& cache = pool.newest();
        int const depth = plane.pixel_depth() + levels;
        std::vector<Tile> const squares = visible_tiles(plane, depth - MergedSquare::most_levels);
        for (Tile const tile : squares) {
            MergedSquare square;
            square.update(cache, tile, depth, merging);
            for (MergedLayer const& merged : square.merged()) {
                ++(merged.tile == merged.first ? alone : together);
                int const n = std::min(plane.tile_side(merged.first), framelet_side);
                for (int y = 0; y < merged.side; ++y) {
                    for (int x = 0; x < merged.side; ++x) {
                        if (layer_of(merged.grid[y * merged.stride + x]) != merged.number) {
                            continue;
                        }
                        PixelRect const rect = plane.tile_rect(merged.tile);
                        double const spacing = static_cast<double>(rect.width()) / merged.side;
                        int const size = plane.tile_side(merged.first);
                        double const px = spacing * (x + 0.5);
                        double const py = spacing * (y + 0.5);
                        CachedFramelet const& framelet = *cache.find(depth, (rect.left + static_cast<int>(px)) / size,
                                                                     (rect.top + static_cast<int>(py)) / size);
                        PackedSample const own =
                            n == framelet_side ? framelet.samples[static_cast<std::size_t>(y % n * n + x % n)]
                                               : framelet.shape.reduced[static_cast<std::size_t>(y % n * n + x % n)];
                        ASSERT_LT(layer_of(own), framelet.shape.layer_count);
                        EXPECT_EQ(own & 0xffffffu, merged.grid[y * merged.stride + x] & 0xffffffu);
                        Layer const& layer = framelet.shape.layers[layer_of(own)].layer;
                        EXPECT_EQ(layer.body, merged.layer.layer.body);
                        double const ox = rect.left + px - plane.tile_rect(framelet.tile).left;
                        double const oy = rect.top + py - plane.tile_rect(framelet.tile).top;
                        Layer const& plane_of = merged.layer.layer;
                        EXPECT_NEAR(plane_of.at + plane_of.dx * px + plane_of.dy * py,
                                    layer.at + layer.dx * ox + layer.dy * oy, merged.difference + 1e-6);
                    }
                }
            }
            for (CoplanarLayers const& quad :
                 square.quads()) { // shown apart it must not reach for its neighbours' samples
                MergedLayer const part = square.merge(quad);
                EXPECT_EQ(part.tile.code, part.first.code >> 2);
                EXPECT_EQ(part.layer.first_column, 0);
                EXPECT_EQ(part.layer.last_row, part.side - 1);
                ++quads;
            }
            outliers += std::popcount(square.children_with_outliers());
        }
    }
    EXPECT_GT(together, 20);
    EXPECT_GT(quads, 20);
    EXPECT_GT(outliers, 0);
    EXPECT_GT(alone, 0);
}

} // namespace
} // namespace framelet
