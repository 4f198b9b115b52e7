#include "common/picture/scene_smoother.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/picture/moved_room.h"

namespace framelet {
namespace {

/// A smoother and what a viewer has besides; what it shows must not depend on what it showed before.
struct Viewer {
    ImagePlane plane{viewport};
    FrameletPool pool{plane};
    SceneSmoother smoother{plane};
    BodyMotions motions;
    Picture picture{viewport.width, viewport.height};
    std::vector<PixelRect> repainted;

    void insert(Batch const& batch) {
        pool.insert(batch, motions);
        smoother.insert(batch, motions);
    }
    Picture const& show(SceneTime time, SceneTime lag = 1, Camera const& camera = front()) {
        std::vector<PixelRect> changed;
        pool.newest().take_changed(changed);
        smoother.show(pool, changed, camera, time, lag, motions, picture, repainted);
        return picture;
    }
    /// The picture that `Reprojector` alone shows.
    Picture unsmoothed(SceneTime time, Camera const& camera = front()) {
        return framelet::show(pool, camera, time, motions).picture;
    }
};

Batch grey(ImagePlane const& plane, std::uint64_t number, SceneTime time, std::uint8_t value, int depth_below = 0) {
    Batch batch = make_batch(plane, number, {});
    batch.view.camera = front();
    batch.scene_time = time;
    for (Tile const tile : visible_tiles(plane, plane.pixel_depth() + depth_below)) {
        batch.framelets.push_back(constant_framelet(plane, tile, value));
    }
    return batch;
}

TEST(SceneSmoother, GoesEvenlyFromWhatWasToWhatComes) {
    Viewer viewer;
    viewer.insert(grey(viewer.plane, 1, 1, 0));
    viewer.insert(grey(viewer.plane, 2, 2, 200));
    int before = 0;
    for (double time = 1; time <= 2; time += 0.125) {
        int const value = viewer.show(time).rgba[0];
        EXPECT_NEAR(value, 200 * std::sqrt(time - 1), 0.51) << time;
        EXPECT_GE(value, before);
        before = value;
    }
    EXPECT_EQ(before, 200);
    viewer.insert(grey(viewer.plane, 3, 2.5, 40));
    EXPECT_EQ(viewer.show(2).rgba[0], 200) << "nothing of it yet";
    EXPECT_EQ(viewer.show(2.5).rgba[0], 40);
}

TEST(SceneSmoother, WhatStoodStillForLongChangesLate) {
    Viewer viewer;
    viewer.insert(grey(viewer.plane, 1, 0, 0));
    viewer.insert(grey(viewer.plane, 2, 10, 200));
    EXPECT_EQ(viewer.show(9.9, 0.1).rgba[0], 0);
    EXPECT_NEAR(viewer.show(9.95, 0.1).rgba[0], 200 * std::sqrt(0.5), 0.51);
}

TEST(SceneSmoother, IsTheReprojectorWhereNothingIsToCome) {
    AnalyticScene const scene = room();
    Viewer viewer;
    viewer.insert(scene.batch(viewer.plane, 1, front(), 0, visible_tiles(viewer.plane, viewer.plane.pixel_depth())));
    EXPECT_EQ(viewer.show(0), viewer.unsmoothed(0));
    viewer.show(0);
    EXPECT_TRUE(viewer.repainted.empty()) << "a still picture costs nothing";
    Camera const aside = look_at(Vec3(0.2f, 1.6f, 5.8f), Vec3(0.05f, 0.95f, 0), Vec3(0, 1, 0), 0.8f);
    EXPECT_EQ(viewer.show(0, 1, aside), viewer.unsmoothed(0, aside));
    EXPECT_EQ(viewer.show(0), viewer.unsmoothed(0));
    // The same holds once it has smoothed and everything has come.
    viewer.insert(grey(viewer.plane, 2, 3, 90, 1));
    EXPECT_NE(viewer.show(2.5), viewer.unsmoothed(2.5));
    EXPECT_EQ(viewer.show(3), viewer.unsmoothed(3));
    viewer.show(3);
    EXPECT_TRUE(viewer.repainted.empty());
}

/// A board that a body carries, rendered at two times: both are moved to where it is between them.
TEST(SceneSmoother, BodiesShowOnceAndNotTwice) {
    AnalyticScene scene = room();
    BodyTrack track{5, 0, {}};
    for (int i = 0; i <= 60; ++i) {
        track.keys.push_back({Vec3(0.6f * static_cast<float>(i) / body_keys_per_second, 0, 0), {1, 0, 0, 0}, Vec3(1)});
    }
    scene.motions.extend(track);
    scene.quads[2].body = 5;
    Viewer viewer;
    viewer.motions = scene.motions;
    std::vector<Tile> const tiles = visible_tiles(viewer.plane, viewer.plane.pixel_depth());
    viewer.insert(scene.batch(viewer.plane, 1, front(), 0.2, tiles));
    viewer.insert(scene.batch(viewer.plane, 2, front(), 0.4, tiles));
    Picture const& got = viewer.show(0.3);
    FrameletPool exact(viewer.plane);
    exact.insert(scene.batch(viewer.plane, 1, front(), 0.3, tiles), scene.motions);
    Picture const wanted = show(exact, front(), 0.3, scene.motions).picture;
    Picture const early = show(filled(scene, front(), 0, 0.2), front(), 0.2, scene.motions).picture;
    auto const error = [&](Picture const& picture) {
        double sum = 0;
        for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
            sum += std::abs(picture.rgba[i] - wanted.rgba[i]);
        }
        return sum;
    };
    EXPECT_LT(error(got), 0.1 * error(early));
}

TEST(SceneSmoother, StepByStepIsAsAllAtOnce) {
    AnalyticScene const scene = room();
    std::mt19937 random(11);
    Viewer stepwise;
    std::vector<Batch> batches;
    double shown = 0;
    for (std::uint64_t number = 1; number <= 25; ++number) {
        double const time = 0.1 * static_cast<double>(number);
        std::vector<Tile> tiles;
        if (number == 1) {
            tiles = visible_tiles(stepwise.plane, stepwise.plane.pixel_depth());
        }
        for (int i = 0; i < 30; ++i) {
            tiles.push_back(random_tile(stepwise.plane, random));
        }
        Batch batch = make_batch(stepwise.plane, number, {});
        batch.view.camera = front();
        batch.scene_time = time;
        for (Tile const tile : tiles) {
            batch.framelets.push_back(random_framelet(stepwise.plane, random));
            batch.framelets.back().tile = tile;
        }
        batches.push_back(batch);
        stepwise.insert(batch);
        for (int step = 0; step < 3; ++step) {
            shown = std::max(0.0, time - 0.25 + 0.03 * step);
            Picture const before = stepwise.picture;
            stepwise.show(shown, 0.25);
            // Pixels outside of `repainted` have not changed.
            Picture patched = before;
            for (PixelRect const& rect : stepwise.repainted) {
                copy_pixels(stepwise.picture, rect, patched);
            }
            ASSERT_EQ(patched, stepwise.picture) << number;
        }
    }
    Viewer at_once;
    for (Batch const& batch : batches) {
        at_once.insert(batch);
    }
    EXPECT_EQ(at_once.show(shown, 0.25), stepwise.picture);
    stepwise.picture = Picture(viewport.width, viewport.height);
    stepwise.smoother.start_picture();
    EXPECT_EQ(stepwise.show(shown, 0.25), at_once.picture) << "another picture is written as a whole";
}

TEST(SceneSmoother, AClockThatIsSetBackLeavesNothingBehind) {
    Viewer viewer;
    viewer.insert(grey(viewer.plane, 1, 8, 10));
    viewer.show(8);
    viewer.insert(grey(viewer.plane, 2, 9, 60)); // never shown, since the clock is set back
    viewer.show(8.5);
    viewer.insert(grey(viewer.plane, 3, 2, 200));
    viewer.show(2);
    EXPECT_EQ(viewer.show(2), viewer.unsmoothed(2));
    EXPECT_EQ(viewer.picture.rgba[0], 200);
}

TEST(SceneSmoother, WhatWaitsIsBounded) {
    Viewer viewer;
    std::vector<std::size_t> bytes;
    for (std::uint64_t number = 1; number <= 10; ++number) {
        viewer.smoother.insert(grey(viewer.plane, number, 1e6, 10, 2), {}); // as many framelets as a pool can hold
        bytes.push_back(viewer.smoother.memory_bytes());
    }
    EXPECT_EQ(bytes.back(), bytes[2]);
}

} // namespace
} // namespace framelet
