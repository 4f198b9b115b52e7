#include "common/fine_merge.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "tests/common/moved_room.h"

namespace framelet {
namespace {

void expect_same(MergedFramelet const* kept, MergedFramelet const* fresh) {
    ASSERT_EQ(kept == nullptr, fresh == nullptr);
    if (kept == nullptr) {
        return;
    }
    EXPECT_EQ(kept->tile, fresh->tile);
    EXPECT_EQ(kept->first, fresh->first);
    EXPECT_EQ(kept->view, fresh->view);
    EXPECT_EQ(kept->layer.layer, fresh->layer.layer);
    EXPECT_EQ(kept->difference, fresh->difference);
    EXPECT_EQ(kept->side, fresh->side);
    EXPECT_EQ(kept->newest_batch, fresh->newest_batch);
    EXPECT_EQ(kept->signature, fresh->signature);
    for (int y = 0; y < kept->side; ++y) {
        EXPECT_TRUE(std::equal(kept->grid + y * kept->stride, kept->grid + y * kept->stride + kept->side,
                               fresh->grid + y * fresh->stride));
    }
}

/// Framelets come and go, of two views, coarse ones over fine ones too.
TEST(FineMerge, WhatIsKeptIsWhatIsThere) {
    ImagePlane const plane(viewport);
    AnalyticScene const scene = room();
    std::mt19937 random(5);
    FrameletCache cache(plane);
    Tile const square = make_tile(plane.pixel_depth() - 1, 4, 4);
    std::array<FineSquare, finest_levels + 1> kept;
    int found = 0;
    for (std::uint64_t number = 1; number < 300; ++number) {
        std::vector<Tile> tiles;
        int const depth = plane.pixel_depth() - 1 + static_cast<int>(random() % 4);
        int const levels = depth - square.depth();
        if (random() % 3 == 0) {
            for (std::uint32_t i = 0; i < 1u << 2 * levels; ++i) {
                tiles.push_back({(square.code << 2 * levels) + i});
            }
        } else {
            tiles.push_back({(square.code << 2 * levels) + static_cast<std::uint32_t>(random()) % (1u << 2 * levels)});
        }
        Batch batch = scene.batch(plane, number, front(), 0, tiles);
        batch.view.number = random() % 16 == 0 ? 2 : 1;
        cache.insert(batch);
        for (int finer = 0; finer <= finest_levels; ++finer) {
            FineSquare fresh;
            FineSquare& own = kept[static_cast<std::size_t>(finer)];
            fresh.update(cache, square, plane.pixel_depth() + finer);
            own.update(cache, square, plane.pixel_depth() + finer);
            for (int level = 0; level <= finer; ++level) {
                for (std::uint32_t i = 0; i < 1u << 2 * level; ++i) {
                    found += own.merged(level, i) != nullptr ? 1 : 0;
                    expect_same(own.merged(level, i), fresh.merged(level, i));
                }
            }
        }
    }
    EXPECT_GT(found, 300);
}

/// What the finest framelets of a plane say is one plane, seen at the tile's corner.
TEST(FineMerge, OnePlaneIsFound) {
    ImagePlane const plane(viewport);
    AnalyticScene scene;
    scene.quads.push_back({{-8, -8, -3}, {16, 0, 4}, {0, 16, 0}, waves(12, 6)});
    Tile const square = make_tile(plane.pixel_depth() - 1, 3, 2);
    for (int finer = 0; finer <= finest_levels; ++finer) {
        FrameletCache const cache = filled(scene, front(), finer);
        FineSquare fine;
        fine.update(cache, square, plane.pixel_depth() + finer);
        for (int level = 0; level <= finer; ++level) {
            MergedFramelet const* const merged = fine.merged(level, 0);
            ASSERT_NE(merged, nullptr);
            EXPECT_EQ(merged->side, 32 >> level);
            Layer const& first = cache
                                     .find(merged->first.depth(), static_cast<int>(merged->first.column()),
                                           static_cast<int>(merged->first.row()))
                                     ->shape.layers[0]
                                     .layer;
            EXPECT_NEAR(merged->layer.layer.at, first.at, 1e-5 * first.at);
            EXPECT_NEAR(merged->layer.layer.dx, first.dx, 1e-5 * first.at);
            EXPECT_LT(merged->difference, 1e-5f * first.at);
        }
    }
}

} // namespace
} // namespace framelet
