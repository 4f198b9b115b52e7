// Compares what is merged with what it was merged from.
#include "common/warp/warp_plan.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "common/warp/warp_block.h"
#include "tests/picture/moved_room.h"

namespace framelet {
namespace {

constexpr unsigned all_parts = (2u << FrameletShape::outlier) - 1;

/// Moves each framelet alone; patches are in the order of the plan.
void alone(FrameletCache const& cache, Camera const& display, SceneTime time, BodyMotions const& motions,
           std::vector<WarpPatch>& patches, std::vector<Splat>& splats) {
    FrameletWarp warp(cache, 0, {}, display, time, motions);
    for (std::size_t slot = 0; slot < cache.slot_count(); ++slot) {
        if (CachedFramelet const* const framelet = cache.at_slot(slot)) {
            warp.add(*framelet, all_parts, patches, splats);
        }
    }
    std::ranges::sort(patches, [](WarpPatch const& a, WarpPatch const& b) {
        return a.batch != b.batch ? a.batch > b.batch : a.tile_layer < b.tile_layer;
    });
}

/// Samples of a car that was far away must not count as good as fresh ones when it has come near.
TEST(MergedWarp, OutliersWearByTheirSpacingOnceMoved) {
    constexpr bool all_outliers = true;
    FrameletPool const pool = filled(room(), front(), 0, 0, all_outliers);
    Camera near = front();
    near.position.z = 3; // the board is 1 m away instead of 4 .. 5
    for (Camera const& camera : {front(), near}) {
        std::vector<WarpPatch> patches;
        std::vector<Splat> splats;
        alone(pool.newest(), camera, 0, {}, patches, splats);
        ASSERT_GT(patches.size(), 10U);
        auto const worn = std::ranges::count_if(patches, [](WarpPatch const& patch) { return patch.worn > 1.2f; });
        EXPECT_TRUE(camera == front() ? worn == 0 : worn > std::ssize(patches) / 2) << worn; // all but the sky
    }
}

/// Scenes of several planes in a framelet, bodies, what deforms, outliers; with all framelets of one batch, with each
/// fifth of one, or with planes of neighbours that do not quite meet.
TEST(MergedWarp, WhatIsMergedShowsAsEachFrameletAlone) {
    ImagePlane const plane(viewport);
    AnalyticScene scene = room();
    BodyTrack track{5, 0, {}};
    for (int i = 0; i <= 60; ++i) {
        auto const time = static_cast<float>(i) / body_keys_per_second;
        track.keys.push_back({Vec3(0.3f * time, 0, 0), glm::angleAxis(0.2f * time, Vec3(0, 0, 1)), Vec3(1)});
    }
    scene.motions.extend(track);
    scene.quads[2].body = 5;
    for (int i = 0; i < 6; ++i) { // more than layers in some framelets
        scene.quads.push_back({{0.2 + 0.04 * i, 1, 2 + 0.1 * i}, {0.04, 0, 0}, {0, 0.3, 0.1}, waves(2, 2)});
    }
    scene.quads[1].body = 6; // without a track: it deforms where it stands, and is no shadow
    scene.quads[1].velocity = {0.1, 0, 0.05};
    Camera const display = look_at(Vec3(0.2f, 1.6f, 5.8f), Vec3(0.05f, 0.95f, 0), Vec3(0, 1, 0), 0.8f);
    std::mt19937 random(4);
    std::normal_distribution<double> normal;
    for (int levels = -1; levels <= finest_levels; ++levels) {
        for (int kind = 0; kind < 3; ++kind) {
            std::size_t const batches = kind == 1 ? 5 : 1;
            double const rough = kind == 2 ? 4e-4 : 0;
            // Of neighbours that are not merged only one shows where something farther was painted between them.
            float const tolerance = kind == 0 ? 2 : 8;
            FrameletCache cache(plane);
            std::vector<Tile> const tiles = visible_tiles(plane, plane.pixel_depth() + levels);
            for (std::size_t k = 0; k < batches; ++k) {
                std::vector<Tile> part;
                for (std::size_t i = k; i < tiles.size(); i += batches) {
                    part.push_back(tiles[i]);
                }
                Batch batch = scene.batch(plane, k + 1, front(), 0, part);
                for (FrameletShape& shape : batch.shapes) {
                    for (Layer& layer : shape.layers) {
                        layer.at *= static_cast<float>(1 + rough * normal(random));
                    }
                }
                cache.insert(batch);
            }
            WarpPlan plan;
            plan.make(cache, 0, {}, display, 0.3, scene.motions);
            std::vector<WarpPatch> each;
            std::vector<Splat> splats;
            alone(cache, display, 0.3, scene.motions, each, splats);
            std::size_t entries = 0, merged_entries = 0;
            int different = 0, shown = 0;
            std::uint8_t noted = 0;
            for (int row = 0; row < plan.rows(); ++row) {
                for (int column = 0; column < plan.columns(); ++column) {
                    std::vector<PatchView> merged, views;
                    merged.clear();
                    plan.add_block(static_cast<std::size_t>(row * plan.columns() + column), merged);
                    order(merged);
                    PixelRect const block{16 * column, 16 * row, 16 * column + 16, 16 * row + 16};
                    for (WarpPatch const& patch : each) {
                        if (patch.box.left < block.right && patch.box.right > block.left &&
                            patch.box.top < block.bottom && patch.box.bottom > block.top) {
                            views.push_back({&patch, splats.data(), &noted});
                        }
                    }
                    entries += views.size();
                    merged_entries += merged.size();
                    WarpedBlock one, other;
                    paint_warped_block(merged, column, row, viewport, one);
                    paint_warped_block(views, column, row, viewport, other);
                    for (std::size_t i = 0; i < WarpedBlock::pixels; ++i) {
                        ++shown;
                        bool same = std::abs(one.inverse_depth[i] - other.inverse_depth[i]) < 1e-3f;
                        for (std::size_t channel = 0; channel < 3; ++channel) {
                            same = same && std::abs(std::sqrt(one.squares[channel][i]) -
                                                    std::sqrt(other.squares[channel][i])) < tolerance;
                        }
                        different += same ? 0 : 1;
                    }
                }
            }
            EXPECT_LT(merged_entries, entries * 4 / 5) << levels << ' ' << kind;
            // Where little of a plane is seen in a framelet, that of its neighbours makes a firm whole of it.
            EXPECT_LE(different, shown / 500) << levels << ' ' << kind;
        }
    }
}

/// A canvas that has uploaded the grids of squares finds all samples of all patches there.
TEST(MergedWarp, PatchesHaveTheirSamplesInTheGridOfTheirSquare) {
    ImagePlane const plane(viewport);
    AnalyticScene scene = room();
    for (int i = 0; i < 6; ++i) { // more than layers in some framelets
        scene.quads.push_back({{0.2 + 0.04 * i, 1, 2 + 0.1 * i}, {0.04, 0, 0}, {0, 0.3, 0.1}, waves(2, 2)});
    }
    std::mt19937 random(4);
    std::normal_distribution<double> normal;
    Batch batch = scene.batch(plane, 1, front(), 0, visible_tiles(plane, plane.pixel_depth() + 1));
    for (FrameletShape& shape : batch.shapes) {
        for (Layer& layer : shape.layers) { // so that some are not merged
            layer.at *= static_cast<float>(1 + 1e-3 * normal(random));
        }
    }
    FrameletCache cache(plane);
    cache.insert(batch);
    WarpPlan plan;
    plan.make(cache, 0, {}, look_at(Vec3(1, 1.6f, 5), Vec3(0, 1, 0), Vec3(0, 1, 0), 0.8f), 0, {});
    int in_grid = 0, alone = 0, compared = 0;
    for (std::uint32_t square = 0; square < plan.square_count(); ++square) {
        MergedSquare const& samples = plan.square_grid(square);
        for (WarpPatch const& patch : plan.patches_of(square)) {
            if (patch.is_outlier) {
                continue;
            }
            ASSERT_EQ(patch.square, square);
            auto const part = plan.grid_part(patch);
            bool const is_in_grid = samples.position_in_grid(patch.grid).has_value();
            ASSERT_TRUE(part || !is_in_grid);
            (is_in_grid ? in_grid : alone) += 1;
            for (int i = 0; part && i < patch.side * patch.side; ++i) {
                int const x = i % patch.side, y = i / patch.side;
                PackedSample const own = patch.grid[y * patch.stride + x];
                PackedSample const there =
                    samples.grid()[static_cast<std::size_t>((part->row + y) * samples.side() + part->column + x)];
                ASSERT_EQ(own & 0xffffffu, there & 0xffffffu);
                ASSERT_EQ(layer_of(own) == patch.layer, layer_of(there) == part->number);
                ++compared;
            }
        }
    }
    EXPECT_GT(in_grid, 0);
    EXPECT_GT(alone, 0);
    EXPECT_GT(compared, 0);
}

} // namespace
} // namespace framelet
