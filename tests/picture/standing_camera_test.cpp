// Tests what a viewer holds of bodies that move in front of a camera that stands.
#include <algorithm>

#include <gtest/gtest.h>

#include "common/picture/reconstruction.h"
#include "tests/picture/moved_room.h"

namespace framelet {
namespace {

ImagePlane const plane(viewport);
std::vector<Tile> const all_tiles = visible_tiles(plane, plane.pixel_depth());

Batch rendered(AnalyticScene const& scene, std::uint64_t number, SceneTime time, std::vector<Tile> const& tiles) {
    Batch batch = scene.batch(plane, number, front(), time, tiles);
    batch.view.number = 1; // it is the same camera
    return batch;
}

/// The tiles in which the board is seen.
std::vector<Tile> board_tiles(AnalyticScene const& scene, SceneTime time) {
    Batch const batch = rendered(scene, 1, time, all_tiles);
    std::vector<Tile> tiles;
    for (std::size_t i = 0; i < batch.framelets.size(); ++i) {
        if (batch.shapes[i].moves()) {
            tiles.push_back(batch.framelets[i].tile);
        }
    }
    return tiles;
}

std::size_t held_of(FrameletPool const& pool, std::uint64_t batch) {
    std::vector<SentTile> held;
    for (std::size_t i = 0; i < pool.slot_count(); ++i) {
        pool.slot(i).add_held(held);
    }
    return static_cast<std::size_t>(std::ranges::count(held, batch, &SentTile::batch));
}

TEST(StandingCamera, ABodyIsHeldWhenItsOldPlaceIsRenderedAgain) {
    AnalyticScene const scene = moving_room();
    std::vector<Tile> const before = board_tiles(scene, 0.5);
    FrameletPool pool(plane);
    pool.insert(rendered(scene, 1, 0, all_tiles), scene.motions);
    EXPECT_TRUE(pool.begins_moment(rendered(scene, 2, 0.5, before), scene.motions));
    pool.insert(rendered(scene, 2, 0.5, before), scene.motions);
    EXPECT_FALSE(pool.begins_moment(rendered(scene, 3, 0.5, before), scene.motions));
    pool.insert(rendered(scene, 3, 1, before), scene.motions); // most of the board's old place is in the open by now
    EXPECT_EQ(held_of(pool, 2), before.size());
    EXPECT_GT(pool.newest().framelet_count(), 0U);

    Picture const got = show(pool, front(), 1, scene.motions).picture;
    ViewRays const rays = make_view_rays(front(), viewport);
    std::vector<Quad> const placed = scene.at_time(1);
    int wrong = 0, board = 0;
    for (int y = 0; y < viewport.height; ++y) {
        for (int x = 0; x < viewport.width; ++x) {
            Hit const hit = scene.cast(placed, rays, x + 0.5, y + 0.5);
            if (hit.quad == 2) {
                ++board;
                wrong += std::abs(static_cast<float>(got.rgba[4 * at(x, y)]) - hit.color[0]) > 16 ? 1 : 0;
            }
        }
    }
    EXPECT_GT(board, 1000);
    EXPECT_LT(wrong, board / 20);
}

TEST(StandingCamera, WhatABodyCoversForAWhileIsHeld) {
    AnalyticScene const scene = moving_room();
    std::vector<Tile> const covered = board_tiles(scene, 1.9);
    FrameletPool pool(plane);
    pool.insert(rendered(scene, 1, 0, all_tiles), scene.motions);
    pool.insert(rendered(scene, 2, 1.9, board_tiles(scene, 0)), scene.motions); // the wall at the board's first place
    std::size_t const held = held_of(pool, 1);
    EXPECT_EQ(held_of(pool, 1) + held_of(pool, 2), all_tiles.size());
    pool.insert(rendered(scene, 3, 1.9, covered), scene.motions);
    EXPECT_EQ(held_of(pool, 1), held);
    for (std::uint64_t i = 0; i < 3 * FrameletPool::most_moments; ++i) { // whatever comes and goes
        pool.insert(rendered(scene, 4 + i, 1.9 + 0.01 * static_cast<double>(i + 1), {covered[covered.size() / 2]}),
                    scene.motions);
    }
    EXPECT_EQ(held_of(pool, 1), held);
    EXPECT_EQ(pool.slot_count(), FrameletPool::most_moments);
    EXPECT_EQ(show(pool, front(), 3.9, scene.motions).hole_share, 0) << "the board has gone by";
}

TEST(StandingCamera, WhatMovedWhenTheBaseBeganGoesAsOtherMomentsDo) {
    AnalyticScene const scene = moving_room();
    FrameletPool pool(plane);
    pool.insert(rendered(scene, 1, 0, all_tiles), scene.motions);
    std::vector<Tile> const moving = board_tiles(scene, 0);
    std::vector<SentTile> gone;
    for (std::uint64_t i = 1; i <= FrameletPool::most_moments; ++i) {
        EXPECT_TRUE(gone.empty());
        pool.insert(rendered(scene, 1 + i, 0.005 * static_cast<double>(i), {moving.front()}), scene.motions);
        pool.take_evicted(gone);
    }
    EXPECT_EQ(std::ranges::count(gone, 1U, &SentTile::batch), static_cast<std::ptrdiff_t>(moving.size()));
    EXPECT_EQ(held_of(pool, 1), all_tiles.size() - moving.size());
}

TEST(StandingCamera, BlocksThatNothingElseTouchesAreExact) {
    AnalyticScene const scene = moving_room();
    FrameletPool pool(plane);
    pool.insert(rendered(scene, 1, 0, all_tiles), scene.motions);
    pool.insert(rendered(scene, 2, 1, all_tiles), scene.motions);
    Picture exact(viewport.width, viewport.height);
    FrameletCache cache(plane);
    cache.insert(rendered(scene, 2, 1, all_tiles));
    reconstruct_all(cache, exact);
    Picture const got = show(pool, front(), 1, scene.motions).picture;
    for (int y = 0; y < viewport.height; ++y) {
        ASSERT_TRUE(std::equal(&got.rgba[4 * at(0, y)], &got.rgba[4 * at(16, y)], &exact.rgba[4 * at(0, y)]));
    }
}

/// The room as in `moving_room`, but the board sets out after three seconds.
AnalyticScene resting_room() {
    AnalyticScene scene = moving_room();
    BodyTrack track{5, 0, {}};
    for (int i = 0; i <= 5 * body_keys_per_second; ++i) {
        float const time = static_cast<float>(i) / body_keys_per_second;
        track.keys.push_back({Vec3(std::max(time - 3, 0.0f), 0, 0), {1, 0, 0, 0}, Vec3(1)});
    }
    scene.motions.extend(track);
    return scene;
}

TEST(StandingCamera, WhatRestsIsHeldAsWhatStands) {
    AnalyticScene const scene = resting_room();
    std::vector<Tile> const board = board_tiles(scene, 0);
    FrameletPool pool(plane);
    pool.insert(rendered(scene, 1, 0, all_tiles), scene.motions);
    Batch const again = rendered(scene, 2, 1, board);
    EXPECT_FALSE(pool.begins_moment(again, scene.motions));
    pool.insert(again, scene.motions);
    EXPECT_EQ(held_of(pool, 1), all_tiles.size() - board.size()) << "the newer takes the place of the older";
    EXPECT_FALSE(pool.has_moving());
    Picture exact(viewport.width, viewport.height);
    reconstruct_all(pool.newest(), exact);
    EXPECT_EQ(show(pool, front(), 2.5, scene.motions).picture, exact);

    Batch const setting_out = rendered(scene, 3, 2.9, {board.front()});
    EXPECT_TRUE(pool.begins_moment(setting_out, scene.motions)) << "it will move before the next may have come";
    pool.insert(setting_out, scene.motions);
    EXPECT_EQ(held_of(pool, 2), board.size());
    EXPECT_NE(show(pool, front(), 3.5, scene.motions).picture, exact);
}

TEST(StandingCamera, WhatRestsStaysHoweverManyMomentsCome) {
    AnalyticScene scene = resting_room();
    Quad other = scene.quads[2];
    other.corner.x -= 1.5f;
    other.body = 6;
    scene.quads.push_back(other);
    BodyTrack track{6, 0, {}};
    for (int i = 0; i <= 5 * body_keys_per_second; ++i) {
        track.keys.push_back({Vec3(0, 0.1f * static_cast<float>(i) / body_keys_per_second, 0), {1, 0, 0, 0}, Vec3(1)});
    }
    scene.motions.extend(track);
    Batch const first = rendered(scene, 1, 0, all_tiles);
    std::size_t still = 0;
    Tile moving;
    for (std::size_t i = 0; i < first.framelets.size(); ++i) {
        if (is_at_rest(first.shapes[i], 0, scene.motions)) {
            ++still;
        } else {
            moving = first.framelets[i].tile;
        }
    }
    EXPECT_LT(still, all_tiles.size());
    FrameletPool pool(plane);
    pool.insert(first, scene.motions);
    for (std::uint64_t i = 1; i <= 2 * FrameletPool::most_moments; ++i) {
        pool.insert(rendered(scene, 1 + i, 0.005 * static_cast<double>(i), {moving}), scene.motions);
    }
    EXPECT_EQ(held_of(pool, 1), still);
}

/// The picture of a settled pool is that of a cache that took everything.
TEST(StandingCamera, SettledItIsAsIfAllHadBeenTakenByOneCache) {
    AnalyticScene const scene = moving_room();
    std::mt19937 random(3);
    FrameletPool pool(plane);
    FrameletCache cache(plane);
    auto const insert = [&](Batch const& batch) {
        pool.insert(batch, scene.motions);
        cache.insert(batch);
    };
    std::uint64_t number = 0;
    insert(rendered(scene, ++number, 0, all_tiles));
    for (int i = 1; i <= 5; ++i) {
        std::vector<Tile> tiles;
        for (int k = 0; k < 60; ++k) {
            Tile const tile = random_tile(plane, random);
            if (std::ranges::find(tiles, tile) == tiles.end()) {
                tiles.push_back(tile);
            }
        }
        insert(rendered(scene, ++number, 0.1 * i, tiles));
    }
    std::vector<Tile> const fine = visible_tiles(plane, plane.pixel_depth() + 1);
    std::vector<Tile> const some(fine.begin(), fine.begin() + 200);
    insert(rendered(scene, ++number, 1, all_tiles));
    insert(rendered(scene, ++number, 1, some));
    Picture picture(viewport.width, viewport.height), expected = picture;
    Reprojector reprojector;
    std::vector<PixelRect> changed, repainted;
    reprojector.show(pool, {}, front(), 1, scene.motions, picture, repainted);
    EXPECT_FALSE(reprojector.is_exact());
    std::vector<SentTile> gone;
    pool.take_evicted(gone);
    EXPECT_TRUE(gone.empty());
    std::size_t const before = pool.framelet_count();
    pool.settle();
    pool.take_evicted(gone);
    EXPECT_FALSE(pool.has_moving());
    EXPECT_EQ(pool.framelet_count(), cache.framelet_count());
    EXPECT_LT(gone.size(), before - pool.framelet_count() + 1);
    for (SentTile const& sent : gone) {
        CachedFramelet const* const held =
            cache.find(sent.tile.depth(), static_cast<int>(sent.tile.column()), static_cast<int>(sent.tile.row()));
        EXPECT_TRUE(held == nullptr || held->moment.batch != sent.batch) << "what is only held elsewhere is not gone";
    }
    pool.newest().take_changed(changed);
    reprojector.show(pool, changed, front(), 1, scene.motions, picture, repainted);
    reconstruct_all(cache, expected);
    EXPECT_TRUE(reprojector.is_exact());
    EXPECT_EQ(picture, expected);
    insert(rendered(scene, ++number, 1, std::vector<Tile>(fine.begin() + 100, fine.begin() + 400)));
    pool.newest().take_changed(changed);
    reprojector.show(pool, changed, front(), 1, scene.motions, picture, repainted);
    reconstruct_all(cache, expected);
    EXPECT_EQ(picture, expected) << "more of the same moment needs no slot of its own";
}

TEST(StandingCamera, ThePlaceOfAnEarlierCameraIsKeptWhenAPictureSettles) {
    AnalyticScene const scene = moving_room();
    FrameletPool pool(plane);
    Batch aside = rendered(scene, 1, 0, all_tiles);
    aside.view.number = 2;
    aside.view.camera.position.x += 1;
    pool.insert(aside, scene.motions);
    pool.insert(rendered(scene, 2, 0.5, all_tiles), scene.motions);
    pool.settle();
    EXPECT_EQ(held_of(pool, 1), all_tiles.size());
}

} // namespace
} // namespace framelet
