#include "common/held/framelet_cache.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "tests/picture/synthetic_framelets.h"

namespace framelet {
namespace {

/// Bytes that FrameletCache says it holds at most for each 4x4 pixels.
constexpr std::size_t most_bytes_per_framelet = 2550;

/// The batch as if from camera number `camera`, each of which is a camera of its own.
Batch seen_from(std::uint64_t camera, Batch batch) {
    batch.view.number = camera;
    batch.view.camera.position.x = static_cast<float>(camera);
    return batch;
}

/// The tile that shows at every finest cell, by the definition: the highest batch, of equals the finest.
std::map<std::pair<int, int>, Tile> shown_cells(ImagePlane const& plane, std::vector<Batch> const& batches) {
    std::map<std::pair<int, int>, std::pair<std::uint64_t, Tile>> cells;
    for (Batch const& batch : batches) {
        for (DisplayFramelet const& framelet : batch.framelets) {
            PixelRect const rect = plane.tile_rect(framelet.tile);
            for (int y = rect.top; y < std::min(rect.bottom, plane.viewport().height); y += 4) {
                for (int x = rect.left; x < std::min(rect.right, plane.viewport().width); x += 4) {
                    auto& cell = cells[{x, y}];
                    bool const finer = framelet.tile.depth() > cell.second.depth();
                    if (batch.number > cell.first || (batch.number == cell.first && finer)) {
                        cell = {batch.number, framelet.tile};
                    }
                }
            }
        }
    }
    std::map<std::pair<int, int>, Tile> out;
    for (auto const& [pixel, cell] : cells) {
        out[pixel] = cell.second;
    }
    return out;
}

std::vector<Batch> random_batches(ImagePlane const& plane, std::mt19937& random, int count, int most_framelets) {
    std::vector<Batch> out;
    for (int i = 1; i <= count; ++i) {
        std::map<Tile, DisplayFramelet> framelets; // a batch names a tile once
        int const framelet_count = std::uniform_int_distribution(1, most_framelets)(random);
        for (int k = 0; k < framelet_count; ++k) {
            DisplayFramelet const framelet = random_framelet(plane, random);
            framelets.emplace(framelet.tile, framelet);
        }
        out.push_back(make_batch(plane, static_cast<std::uint64_t>(i), {}));
        for (auto const& [tile, framelet] : framelets) {
            out.back().framelets.push_back(framelet);
        }
    }
    return out;
}

std::set<Tile> held_tiles(FrameletCache const& cache) {
    std::set<Tile> out;
    ImagePlane const& plane = cache.plane();
    for (int depth = plane.min_depth(); depth <= plane.max_depth(); ++depth) {
        for (Tile const tile : visible_tiles(plane, depth)) {
            if (cache.find(depth, static_cast<int>(tile.column()), static_cast<int>(tile.row())) != nullptr) {
                out.insert(tile);
            }
        }
    }
    return out;
}

TEST(FrameletCache, HoldsExactlyWhatShowsWhateverTheOrder) {
    for (Viewport const viewport : {Viewport{1, 1}, Viewport{17, 5}, Viewport{130, 70}, Viewport{320, 200}}) {
        ImagePlane const plane(viewport);
        std::mt19937 random(static_cast<unsigned>(viewport.width));
        std::vector<Batch> batches = random_batches(plane, random, 60, 20);
        auto const cells = shown_cells(plane, batches);
        std::set<Tile> shown;
        for (auto const& [pixel, tile] : cells) {
            shown.insert(tile);
        }
        auto const finest_cells = static_cast<double>(((viewport.width + 3) / 4) * ((viewport.height + 3) / 4));
        for (int order = 0; order < 4; ++order) {
            FrameletCache cache(plane);
            for (Batch const& batch : batches) {
                cache.insert(batch);
                ASSERT_LE(static_cast<double>(cache.framelet_count()), finest_cells);
            }
            EXPECT_EQ(held_tiles(cache), shown) << viewport.width << "x" << viewport.height << ", order " << order;
            EXPECT_EQ(cache.framelet_count(), shown.size());
            std::shuffle(batches.begin(), batches.end(), random);
            for (Batch& batch : batches) {
                std::shuffle(batch.framelets.begin(), batch.framelets.end(), random);
            }
        }
    }
}

TEST(FrameletCache, CoverageIsTheShareOfPixels) {
    ImagePlane const plane(Viewport{100, 60});
    FrameletCache cache(plane);
    EXPECT_EQ(cache.coverage(), 0);
    int const depth = plane.pixel_depth();
    cache.insert(make_batch(plane, 1, {constant_framelet(plane, make_tile(depth, 0, 0), 9)}));
    EXPECT_DOUBLE_EQ(cache.coverage(), 256 / 6000.0);
    // Only 4 columns and 12 rows of this tile are in the viewport.
    cache.insert(make_batch(plane, 2, {constant_framelet(plane, make_tile(depth, 6, 3), 9)}));
    EXPECT_DOUBLE_EQ(cache.coverage(), (256 + 48) / 6000.0);
    // A finer framelet inside adds nothing.
    cache.insert(make_batch(plane, 3, {constant_framelet(plane, make_tile(depth + 1, 1, 1), 9)}));
    EXPECT_DOUBLE_EQ(cache.coverage(), (256 + 48) / 6000.0);
    cache.insert(make_batch(plane, 4, shade_tiles(plane, visible_tiles(plane, plane.min_depth()), [](float, float) {
                                return std::array<std::uint8_t, 3>{};
                            })));
    EXPECT_DOUBLE_EQ(cache.coverage(), 1);
    EXPECT_EQ(cache.framelet_count(), visible_tiles(plane, plane.min_depth()).size());
}

TEST(FrameletCache, OlderBatchNeverReplacesNewer) {
    ImagePlane const plane(Viewport{64, 64});
    FrameletCache cache(plane);
    Tile const tile = make_tile(plane.pixel_depth(), 1, 2);
    EXPECT_EQ(cache.insert(make_batch(plane, 5, {constant_framelet(plane, tile, 50)})), 1u);
    EXPECT_EQ(cache.insert(make_batch(plane, 4, {constant_framelet(plane, tile, 40)})), 0u);
    EXPECT_EQ(cache.insert(make_batch(plane, 4, {constant_framelet(plane, tile.child(2), 40)})), 0u);
    EXPECT_EQ(cache.insert(make_batch(plane, 4, {constant_framelet(plane, tile.parent(), 40)})), 1u);
    EXPECT_EQ(cache.find(plane.pixel_depth(), 1, 2)->samples[0] & 255u, 50u);
    EXPECT_EQ(cache.insert(make_batch(plane, 6, {constant_framelet(plane, tile.parent(), 60)})), 1u);
    EXPECT_EQ(cache.find(plane.pixel_depth(), 1, 2), nullptr);
    EXPECT_EQ(cache.framelet_count(), 1u);
}

TEST(FrameletCache, SamplesAreInRows) {
    ImagePlane const plane(Viewport{16, 16});
    FrameletCache cache(plane);
    Tile const tile = make_tile(plane.pixel_depth(), 0, 0);
    cache.insert(make_batch(plane, 1, {shade_framelet(plane, tile, [](float x, float y) {
                                return std::array{static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y),
                                                  static_cast<std::uint8_t>(std::floor(x) + 16 * std::floor(y))};
                            })}));
    CachedFramelet const* const held = cache.find(plane.pixel_depth(), 0, 0);
    ASSERT_NE(held, nullptr);
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        EXPECT_EQ(red_of(held->samples[i]), i % 16);
        EXPECT_EQ(green_of(held->samples[i]), i / 16);
    }
}

TEST(FrameletCache, ViewsAreKnownAsLongAsTheirFrameletsAreHeld) {
    ImagePlane const plane(Viewport{64, 64});
    FrameletCache cache(plane);
    auto const insert = [&](std::uint64_t number, std::uint32_t column, BodyNumber body) {
        Batch batch =
            make_batch(plane, number, {constant_framelet(plane, make_tile(plane.pixel_depth(), column, 0), 9)});
        batch.view.number = number;
        batch.view.camera.position.x = static_cast<float>(number);
        FrameletShape shape;
        shape.layer_count = 1;
        shape.layers[0].body = body;
        batch.shapes = {shape};
        cache.insert(batch);
    };
    auto const view_at = [&](int column) { return cache.views()[cache.find(plane.pixel_depth(), column, 0)->view]; };
    insert(1, 0, static_body);
    insert(2, 1, 7);
    EXPECT_EQ(view_at(0).camera.position.x, 1);
    EXPECT_EQ(view_at(1).camera.position.x, 2);
    EXPECT_EQ(view_at(0).moving_framelets, 0u);
    EXPECT_EQ(view_at(1).moving_framelets, 1u);
    for (std::uint64_t number = 3; number < 20; ++number) {
        insert(number, static_cast<std::uint32_t>(number % 2), static_body);
        EXPECT_EQ(view_at(static_cast<int>(number % 2)).number, number);
        EXPECT_EQ(view_at(static_cast<int>(number % 2)).framelets, 1u);
        EXPECT_LE(cache.views().size(), 3);
    }
}

TEST(FrameletCache, ChangesAreRectanglesOfBlocksAndAreTakenOnce) {
    ImagePlane const plane(Viewport{100, 60});
    FrameletCache cache(plane);
    std::vector<PixelRect> changed{{1, 2, 3, 4}};
    cache.take_changed(changed);
    EXPECT_TRUE(changed.empty());
    int const depth = plane.pixel_depth();
    cache.insert(make_batch(plane, 1,
                            {constant_framelet(plane, make_tile(depth, 1, 0), 1),
                             constant_framelet(plane, make_tile(depth, 2, 0), 1),
                             constant_framelet(plane, make_tile(depth + 2, 25 - 1, 14), 1)}));
    cache.take_changed(changed);
    EXPECT_EQ(changed, (std::vector<PixelRect>{{16, 0, 48, 16}, {96, 48, 100, 60}}));
    cache.take_changed(changed);
    EXPECT_TRUE(changed.empty());
}

/// Whatever comes in whatever order from wherever: a place that has shown something goes on showing something.
TEST(FrameletCache, NeverDropsTheOnlyContentOfAPlace) {
    ImagePlane const plane({130, 70});
    std::mt19937 random(31);
    std::vector<Batch> batches = random_batches(plane, random, 200, 6);
    for (Batch& batch : batches) {
        batch.view.number = random() % 9;
        batch.view.camera.position.x = static_cast<float>(batch.view.number);
        batch.scene_time = static_cast<double>(random() % 5);
    }
    std::shuffle(batches.begin(), batches.end(), random);
    FrameletCache cache(plane);
    std::set<std::pair<int, int>> covered;
    for (Batch const& batch : batches) {
        cache.insert(batch);
        std::set<std::pair<int, int>> now;
        for (Tile const tile : held_tiles(cache)) {
            PixelRect const rect = plane.tile_rect(tile);
            for (int y = rect.top; y < std::min(rect.bottom, plane.viewport().height); y += 4) {
                for (int x = rect.left; x < std::min(rect.right, plane.viewport().width); x += 4) {
                    now.emplace(x, y);
                }
            }
        }
        ASSERT_TRUE(std::ranges::includes(now, covered));
        covered = std::move(now);
    }
    EXPECT_GT(covered.size(), 300U);
}

/// The most that can be held: the finest framelets everywhere, each of its own view, no sample on a layer.
TEST(FrameletCache, MemoryIsBounded) {
    ImagePlane const plane({320, 192});
    std::vector<Tile> const tiles = visible_tiles(plane, plane.max_depth());
    FrameletShape outliers;
    outliers.layer_of.fill(FrameletShape::outlier);
    outliers.outliers.resize(framelet_samples);
    FrameletCache cache(plane);
    std::uint64_t number = 0;
    for (int round = 0; round < 3; ++round) {
        for (Tile const tile : tiles) {
            Batch batch = make_batch(plane, ++number, {constant_framelet(plane, tile, 9)});
            batch.shapes.push_back(outliers);
            cache.insert(seen_from(number, batch));
        }
        EXPECT_EQ(cache.framelet_count(), tiles.size());
        EXPECT_LE(cache.memory_bytes(), most_bytes_per_framelet * tiles.size());
    }
}

/// Each moment has a cache, and in motion no framelet is finer than pixels.
TEST(FrameletCache, HasNoRoomForWhatIsFinerThanPixelsUntilItComes) {
    ImagePlane const plane({640, 360});
    FrameletCache cache(plane);
    std::size_t const empty = cache.memory_bytes();
    auto const hold = [&](std::uint64_t number, int depth) {
        cache.insert(make_batch(plane, number, {constant_framelet(plane, make_tile(depth, 3, 2), 9)}));
        EXPECT_EQ(cache.finest_depth(), std::max(depth, plane.pixel_depth()));
        EXPECT_NE(cache.find(depth, 3, 2), nullptr);
        EXPECT_EQ(cache.find(plane.max_depth(), 3, 2) != nullptr, depth == plane.max_depth());
    };
    hold(1, plane.pixel_depth() - 1);
    hold(2, plane.pixel_depth());
    EXPECT_LT(cache.memory_bytes() - sizeof(FrameletRoom::Chunk), 2 * empty);
    hold(3, plane.max_depth());
    EXPECT_GT(cache.memory_bytes() - sizeof(FrameletRoom::Chunk), 10 * empty);
}

TEST(FrameletCache, KeepsOnlyWhatItIsTold) {
    ImagePlane const plane({64, 64});
    FrameletCache cache(plane);
    Tile const small = make_tile(plane.pixel_depth(), 1, 2);
    Tile const other = make_tile(plane.pixel_depth(), 3, 0);
    cache.insert(make_batch(plane, 1, {constant_framelet(plane, small.parent(), 9)}));
    cache.insert(make_batch(plane, 2, {constant_framelet(plane, small, 9), constant_framelet(plane, other, 9)}));
    std::vector<PixelRect> changed;
    cache.take_changed(changed);
    std::array const kept{small, small, make_tile(plane.pixel_depth(), 0, 0)};
    std::vector<SentTile> gone;
    cache.keep(kept, gone);
    std::ranges::sort(gone);
    EXPECT_EQ(gone, (std::vector<SentTile>{{1, small.parent()}, {2, other}}));
    EXPECT_EQ(cache.framelet_count(), 1U);
    EXPECT_NE(cache.find(plane.pixel_depth(), 1, 2), nullptr);
    EXPECT_EQ(cache.find(plane.pixel_depth(), 3, 0), nullptr);
    EXPECT_EQ(cache.coverage(), 1.0 / 16);
    cache.take_changed(changed);
    EXPECT_FALSE(changed.empty());
    cache.clear();
    EXPECT_EQ(cache.framelet_count(), 0U);
    EXPECT_EQ(cache.coverage(), 0);
    EXPECT_EQ(cache.find(plane.pixel_depth(), 1, 2), nullptr);
    cache.insert(make_batch(plane, 3, {constant_framelet(plane, other, 9)}));
    EXPECT_EQ(cache.framelet_count(), 1U);
    EXPECT_EQ(cache.coverage(), 1.0 / 16);
}

TEST(FrameletCache, IsCoveredFromADepthByWhatIsAsFine) {
    ImagePlane const plane({48, 32});
    FrameletCache cache(plane);
    std::uint64_t number = 0;
    for (Tile const tile : visible_tiles(plane, plane.pixel_depth() - 1)) {
        cache.insert(make_batch(plane, ++number, {constant_framelet(plane, tile, 9)}));
    }
    EXPECT_TRUE(cache.is_covered_from(plane.pixel_depth() - 1));
    EXPECT_FALSE(cache.is_covered_from(plane.pixel_depth()));
    for (Tile const tile : visible_tiles(plane, plane.pixel_depth() + 1)) {
        EXPECT_FALSE(cache.is_covered_from(plane.pixel_depth()));
        cache.insert(make_batch(plane, ++number, {constant_framelet(plane, tile, 9)}));
    }
    EXPECT_TRUE(cache.is_covered_from(plane.pixel_depth()));
}

TEST(FrameletCache, SteadyStateAllocatesNothing) {
    ImagePlane const plane(Viewport{640, 360});
    FrameletCache cache(plane);
    auto const fill = [&](std::uint64_t number, int depth) {
        Batch batch = make_batch(plane, number, {});
        for (Tile const tile : visible_tiles(plane, depth)) {
            batch.framelets.push_back(constant_framelet(plane, tile, static_cast<std::uint8_t>(number)));
        }
        cache.insert(batch);
    };
    std::uint64_t number = 0;
    for (int depth = plane.min_depth(); depth <= plane.max_depth(); ++depth) {
        fill(++number, depth);
    }
    std::size_t const full = cache.memory_bytes();
    for (int round = 0; round < 3; ++round) {
        for (int depth = plane.min_depth(); depth <= plane.max_depth(); ++depth) {
            fill(++number, depth);
        }
    }
    EXPECT_EQ(cache.memory_bytes(), full);
    EXPECT_EQ(cache.framelet_count(), visible_tiles(plane, plane.max_depth()).size());
}

} // namespace
} // namespace framelet
