#include "common/warp/warp_plan.h"

#include <gtest/gtest.h>

#include "tests/picture/analytic_scene.h"
#include "tests/picture/synthetic_framelets.h"

namespace framelet {
namespace {

constexpr Viewport viewport{320, 192};

Camera front() {
    return look_at(Vec3(0, 0, 5), Vec3(0, 0, 0), Vec3(0, 1, 0), 0.8f);
}

AnalyticScene wall() {
    AnalyticScene scene;
    scene.quads.push_back({{-8, -8, 0}, {16, 0, 0}, {0, 16, 0}, [](double, double) { return Color{90, 90, 90}; }});
    return scene;
}

/// Number of patches of all blocks together.
std::size_t entries_of(WarpPlan& plan) {
    std::vector<PatchView> patches;
    for (std::size_t i = 0; i < static_cast<std::size_t>(plan.columns() * plan.rows()); ++i) {
        plan.add_block(i, patches);
    }
    return patches.size();
}

/// Every framelet flies to right in front of the camera, where it is larger than the picture.
TEST(WarpPlan, HoldsBoundedlyManyPatchesAndTheNewestOnes) {
    ImagePlane const plane(viewport);
    FrameletCache cache(plane);
    ViewRays const rays = make_view_rays(front(), viewport);
    std::vector<Tile> const tiles = visible_tiles(plane, plane.pixel_depth() + 1);
    std::uint64_t number = 0;
    for (Tile const tile : tiles) {
        Batch batch = wall().batch(plane, ++number, front(), 0, {tile});
        PixelRect const rect = plane.tile_rect(tile);
        Vec3 const towards = rays.direction + rays.direction_dx * (static_cast<float>(rect.left) + 4) +
                             rays.direction_dy * (static_cast<float>(rect.top) + 4);
        batch.shapes[0].layers[0].drift.corner.velocity = Vec3(0, 0, -0.02f) - 5.0f * towards;
        cache.insert(batch);
    }
    WarpPlan plan;
    plan.make(cache, 0, {}, front(), 1, {});
    auto const blocks = static_cast<std::size_t>(plan.columns() * plan.rows());
    ASSERT_GT(tiles.size(), 2 * WarpPlan::most_patches_per_block);
    EXPECT_LE(entries_of(plan), WarpPlan::most_patches_per_block * blocks);
    EXPECT_GT(entries_of(plan), WarpPlan::most_patches_per_block * blocks / 2);
    std::vector<PatchView> patches;
    for (std::size_t i = 0; i < blocks; ++i) {
        patches.clear();
        plan.add_block(i, patches);
        order(patches);
        ASSERT_FALSE(patches.empty());
        ASSERT_EQ(patches[0].patch->batch, number);
    }
}

TEST(WarpPlan, FrameletsOfOnePlaneAreOnePatchForManyBlocks) {
    ImagePlane const plane(viewport);
    Camera aside = front();
    aside.position.x += 0.1f;
    for (int levels = 0; levels <= finest_levels; ++levels) {
        FrameletCache cache(plane);
        cache.insert(wall().batch(plane, 1, front(), 0, visible_tiles(plane, plane.pixel_depth() + levels)));
        WarpPlan plan;
        plan.make(cache, 0, {}, aside, 0, {});
        EXPECT_GT(entries_of(plan), 0u);
        // A patch of a block alone reaches three blocks upright and two across.
        EXPECT_LT(entries_of(plan), static_cast<std::size_t>(4 * plan.columns() * plan.rows())) << levels;
    }
}

std::size_t squares_with_room(WarpPlan& plan) {
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < plan.square_count(); ++i) {
        count += plan.square_grid(i).grid().empty() ? 0 : 1;
    }
    return count;
}

/// A moment that comes soon finds the room of the last one; what stays empty is given back.
TEST(WarpPlan, GivesBackTheRoomOfSquaresThatStayEmpty) {
    ImagePlane const plane(viewport);
    FrameletCache cache(plane);
    WarpPlan plan;
    int number = 0;
    auto const show = [&] { plan.make(cache, 0, {}, front(), number * 0.01, {}); };
    auto const hold = [&](int depth) {
        cache.insert(
            wall().batch(plane, static_cast<std::uint64_t>(++number), front(), 0, visible_tiles(plane, depth)));
    };
    hold(plane.pixel_depth());
    show();
    std::size_t const at_pixels = squares_with_room(plan);
    ASSERT_GT(at_pixels, 0u);
    cache.clear();
    hold(plane.pixel_depth() - 1);
    show();
    std::size_t const at_both = squares_with_room(plan);
    EXPECT_GT(at_both, at_pixels) << "it may be needed soon";
    for (int i = 0; i < WarpPlan::most_empty_pictures; ++i) {
        show();
    }
    EXPECT_EQ(squares_with_room(plan), at_both - at_pixels) << "what is held has its room";
    cache.clear();
    hold(plane.pixel_depth());
    for (int i = 0; i < WarpPlan::most_empty_pictures / 2; ++i) {
        show();
    }
    cache.clear();
    show();
    hold(plane.pixel_depth());
    for (int i = 0; i < WarpPlan::most_empty_pictures; ++i) {
        show();
    }
    EXPECT_EQ(squares_with_room(plan), at_pixels) << "what comes back is counted anew";
    EXPECT_GT(entries_of(plan), 0u);
}

/// Blocks that are not flagged have the patches that they had, also where one has left.
TEST(WarpPlan, FlagsEachBlockOfWhichThePatchesAreOthers) {
    ImagePlane const plane(viewport);
    FrameletCache cache(plane);
    AnalyticScene scene;
    scene.quads.push_back({{-0.3, -0.3, 0}, {0.6, 0, 0}, {0, 0.6, 0}, [](double, double) {
                               return Color{90, 90, 90};
                           }});
    scene.quads[0].body = 5;
    scene.motions.extend({5, 0, {BodyPose{}, BodyPose{Vec3(1.5f, 0, 0)}, BodyPose{Vec3(-1.5f, 0, 0)}}});
    Batch const batch = scene.batch(plane, 1, front(), 0, visible_tiles(plane, plane.pixel_depth() + 1));
    cache.insert(batch);
    WarpPlan plan;
    std::vector<std::vector<std::uint64_t>> before;
    int unflagged = 0;
    for (double const time : {0.0, 1.0, 1.0, 2.0, 1.5}) {
        plan.make(cache, 0, {}, front(), time / body_keys_per_second, scene.motions);
        auto const blocks = static_cast<std::size_t>(plan.columns() * plan.rows());
        before.resize(blocks);
        std::vector<std::uint8_t> flags(blocks);
        plan.flag_replanned(flags);
        for (std::size_t i = 0; i < blocks; ++i) {
            std::vector<PatchView> patches;
            plan.add_block(i, patches);
            order(patches);
            std::vector<std::uint64_t> now;
            for (PatchView const& view : patches) {
                now.push_back(view.patch->signature);
            }
            EXPECT_TRUE(flags[i] != 0 || now == before[i]) << i << ' ' << time;
            unflagged += flags[i] == 0 ? 1 : 0;
            before[i] = now;
        }
    }
    EXPECT_GT(unflagged, 0);
}

} // namespace
} // namespace framelet
