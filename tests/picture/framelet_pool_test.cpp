#include "common/held/framelet_pool.h"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <vector>

#include "tests/picture/synthetic_framelets.h"

namespace framelet {
namespace {

ImagePlane const plane({64, 64});

Batch seen_from(std::uint64_t camera, std::uint64_t number, Tile tile) {
    Batch batch = make_batch(plane, number, {constant_framelet(plane, tile, static_cast<std::uint8_t>(number))});
    batch.view.number = camera;
    batch.view.camera.position.x = static_cast<float>(camera);
    return batch;
}

Tile const small_tile = make_tile(plane.pixel_depth(), 1, 2);

std::set<std::uint64_t> cameras(FrameletPool const& pool) {
    std::set<std::uint64_t> out;
    for (std::size_t i = 0; i < pool.slot_count(); ++i) {
        if (CachedFramelet const* const framelet = pool.slot(i).find(plane.pixel_depth(), 1, 2)) {
            out.insert(framelet->moment.camera);
        }
    }
    return out;
}

TEST(FrameletPool, AnotherCameraBeginsAMomentAndTakesNothingAway) {
    FrameletPool pool(plane);
    pool.insert(seen_from(1, 1, small_tile), {});
    pool.insert(seen_from(1, 2, small_tile), {}); // replaces the first
    pool.insert(seen_from(2, 3, small_tile), {});
    EXPECT_EQ(pool.framelet_count(), 2U);
    EXPECT_EQ(cameras(pool), (std::set<std::uint64_t>{1, 2}));
    EXPECT_EQ(pool.newest().framelet_count(), 1U);
    EXPECT_EQ(pool.newest().find(plane.pixel_depth(), 1, 2)->moment.batch, 3U);
}

TEST(FrameletPool, WithoutMomentsTheNewestOfAPlaceIsHeld) {
    FrameletPool pool(plane);
    for (std::uint64_t camera = 1; camera < 30; ++camera) {
        pool.insert(seen_from(camera, camera, small_tile), {}, false);
        EXPECT_EQ(pool.framelet_count(), 1U);
        EXPECT_EQ(cameras(pool), (std::set<std::uint64_t>{camera}));
    }
}

TEST(FrameletPool, WhatIsNotToBeMovedSharesACache) {
    FrameletPool pool(plane);
    for (std::uint64_t camera = 1; camera < 5; ++camera) {
        Batch batch = seen_from(camera, camera, small_tile);
        batch.view.camera.projection = Projection::orthographic;
        pool.insert(batch, {});
        EXPECT_EQ(pool.framelet_count(), 1U);
    }
}

TEST(FrameletPool, TheMomentGoesOfWhichLeastShows) {
    FrameletPool pool(plane);
    for (std::uint64_t camera = 1; camera <= FrameletPool::most_moments; ++camera) {
        pool.insert(seen_from(camera, camera, small_tile), {});
    }
    EXPECT_EQ(pool.framelet_count(), FrameletPool::most_moments);
    std::vector<std::uint32_t> shown(pool.slot_count(), 7);
    shown[2] = 1;
    pool.note_shown(shown);
    pool.insert(seen_from(100, 100, small_tile), {});
    EXPECT_EQ(pool.slot_count(), FrameletPool::most_moments);
    EXPECT_FALSE(cameras(pool).contains(3));
    EXPECT_TRUE(cameras(pool).contains(1));
    std::vector<SentTile> gone;
    pool.take_evicted(gone);
    EXPECT_EQ(gone, (std::vector<SentTile>{{3, small_tile}}));
    pool.take_evicted(gone);
    EXPECT_TRUE(gone.empty()) << "said once";
    pool.insert(seen_from(101, 101, small_tile), {}); // evicts the oldest of those that show as little
    EXPECT_FALSE(cameras(pool).contains(1));
    EXPECT_TRUE(cameras(pool).contains(100)) << "what has hardly been shown stays";
}

/// A framelet that drifts to the right, before the same camera at any time.
Batch drifting(std::uint64_t number, SceneTime time, bool is_brief) {
    Batch batch = seen_from(1, number, small_tile);
    batch.scene_time = time;
    FrameletShape shape;
    shape.layer_count = 1;
    shape.layers[0].at = 0.1f;
    shape.layers[0].drift.corner.velocity = Vec3(1, 0, 0);
    shape.is_brief = is_brief;
    batch.shapes = {shape};
    return batch;
}

TEST(FrameletPool, WhatDriftsBrieflyIsReplacedInItsPlace) {
    for (bool const is_brief : {false, true}) {
        FrameletPool pool(plane);
        for (std::uint64_t number = 1; number <= 3; ++number) {
            Batch const batch = drifting(number, 0.1 * static_cast<double>(number), is_brief);
            EXPECT_EQ(pool.begins_moment(batch, {}), number == 1 || !is_brief);
            pool.insert(batch, {});
        }
        EXPECT_EQ(pool.framelet_count(), is_brief ? 1U : 3U);
        CachedFramelet const* const newest = pool.newest().find(plane.pixel_depth(), 1, 2);
        ASSERT_TRUE(newest);
        EXPECT_EQ(newest->moment.batch, is_brief ? 3U : 1U);
    }
}

TEST(FrameletPool, HoldsAsManyMomentsAsItIsTold) {
    FrameletPool pool(plane, 4);
    for (std::uint64_t camera = 1; camera <= 9; ++camera) {
        pool.insert(seen_from(camera, camera, small_tile), {});
    }
    EXPECT_EQ(pool.slot_count(), 4U);
    EXPECT_TRUE(cameras(pool).contains(9));
}

TEST(FrameletPool, MemoryIsBoundedHoweverManyCamerasThereAre) {
    FrameletPool pool(plane);
    std::size_t most = 0;
    for (std::uint64_t camera = 1; camera < 500; ++camera) {
        Batch batch = seen_from(camera, camera, small_tile);
        for (Tile const tile : visible_tiles(plane, plane.max_depth())) {
            batch.framelets.push_back(constant_framelet(plane, tile, 1));
        }
        pool.insert(batch, {});
        if (camera == 2 * FrameletPool::most_moments) {
            most = pool.memory_bytes();
        }
    }
    EXPECT_LE(pool.memory_bytes(), most);
}

TEST(FrameletPool, RoomForAPictureAtRestIsNotKeptByEachMoment) {
    ImagePlane const large({256, 256});
    std::uint64_t camera = 0;
    FrameletPool pool(large);
    auto const look = [&](int depth) {
        std::vector<DisplayFramelet> framelets;
        for (Tile const tile : visible_tiles(large, depth)) {
            framelets.push_back(constant_framelet(large, tile, 1));
        }
        Batch batch = make_batch(large, ++camera, std::move(framelets));
        batch.view.number = camera;
        batch.view.camera.position.x = static_cast<float>(camera);
        pool.insert(batch, {});
    };
    look(large.max_depth());
    std::size_t const at_rest = pool.memory_bytes();
    for (int stop = 0; stop < 20; ++stop) {
        for (std::size_t moment = 0; moment < FrameletPool::most_moments; ++moment) {
            look(large.min_depth());
        }
        look(large.max_depth());
    }
    std::size_t const moments =
        FrameletPool::most_moments * (FrameletCache(large).memory_bytes() + sizeof(FrameletRoom::Chunk));
    EXPECT_LE(pool.memory_bytes(), at_rest + 2 * moments);
}

} // namespace
} // namespace framelet
