#include "server/stream/layers/shape_feed.h"

#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include "common/clock_state.h"
#include "common/framelet/body_motion.h"
#include "protocol/codec/geometry/track_codec.h"

namespace framelet {
namespace {

/// A scene of bodies that go 3 metres a second along x, for a minute.
struct Drive {
    Scene scene;
    std::array<Index, 1> clips{0};
    SceneBodies bodies;
    std::optional<PoseEvaluator> poses;
    ShapeFeed feed;
    BodyMotions viewer;

    explicit Drive(Index count = 1) {
        scene.meshes.resize(1);
        scene.nodes.resize(static_cast<std::size_t>(count));
        scene.clips.resize(1);
        scene.clips[0].duration = 60;
        for (Index i = 0; i < count; ++i) {
            scene.nodes[static_cast<std::size_t>(i)].mesh = 0;
            scene.clips[0].channels.push_back(
                {i, AnimatedProperty::translation, Interpolation::linear, 3, {0, 60}, {0, 0, 0, 180, 0, 0}});
        }
        bodies = find_bodies(scene, clips);
        poses.emplace(scene, clips);
    }

    /// Number of keys that the batch of `time` took.
    std::size_t batch(SceneTime time) { return batch(time, time); }
    std::size_t batch(SceneTime present, SceneTime time) {
        std::vector<BodyTrack> tracks;
        std::optional<BodyTrack> camera;
        feed.track(*poses, bodies, -1, present, time, tracks, camera);
        std::size_t keys = 0;
        for (BodyTrack const& track : tracks) {
            keys += track.keys.size();
            viewer.extend(track);
        }
        return keys;
    }
    double moved(SceneTime from, SceneTime to) const { return viewer.between(1, from, to).offset.x; }
};

TEST(ShapeFeed, AllIsKnownWhateverThePausesBetweenBatches) {
    Drive drive;
    double time = 1;
    for (double const pause : {0.01, 0.02, 0.3, 0.7, 0.02, 1.5, 4.0, 0.1}) {
        time += pause;
        drive.batch(time);
        EXPECT_NEAR(drive.moved(1.1, time + 0.3), 3 * (time + 0.3 - 1.1), 1e-4) << pause;
    }
}

TEST(ShapeFeed, TracksFitIntoABatchHoweverManyBodiesThereAre) {
    for (Index const count : {300, 4000, 4096, 4097, 20'000}) {
        Drive drive(count);
        std::vector<BodyTrack> tracks;
        std::optional<BodyTrack> camera;
        for (double const time : {1.0, 1.02, 1.2, 2.9, 7.0, 0.5}) {
            drive.feed.track(*drive.poses, drive.bodies, -1, time, time, tracks, camera);
            EXPECT_LE(tracks.size(), max_batch_tracks);
            EXPECT_FALSE(encode_tracks(tracks, camera).empty()); // which checks all limits
        }
    }
}

TEST(ShapeFeed, KeysAreGivenOutOnce) {
    Drive drive;
    std::size_t keys = 0;
    for (int i = 0; i <= 100; ++i) {
        keys += drive.batch(2 + 0.01 * i);
    }
    EXPECT_NEAR(static_cast<double>(keys), (1 + 0.8) * body_keys_per_second, 3)
        << "0.3 s ahead, and 0.5 more each second";
    EXPECT_EQ(drive.batch(3), 0u);
}

TEST(ShapeFeed, InTheEndASecondAheadIsKnown) {
    Drive drive;
    for (int i = 0; i <= 200; ++i) {
        drive.batch(2 + 0.01 * i);
    }
    EXPECT_NEAR(drive.moved(2, 4 + tracked_ahead_seconds), 3 * (2 + tracked_ahead_seconds), 1e-4);
}

TEST(ShapeFeed, AfterALeapOfTheClockOnlyWhatIsNearIsGivenOut) {
    Drive drive;
    drive.batch(2);
    double const once = 0.3 * body_keys_per_second;
    EXPECT_NEAR(static_cast<double>(drive.batch(50)), once, 3) << "forwards";
    EXPECT_NEAR(static_cast<double>(drive.batch(1)), once, 3) << "backwards";
    EXPECT_NEAR(drive.moved(1, 1.2), 0.6, 1e-4);
}

TEST(ShapeFeed, WhatIsShownUntilTheFirstMomentIsKnown) {
    Drive drive;
    drive.batch(2, 2.4);
    EXPECT_NEAR(drive.moved(2, 2.7), 2.1, 1e-4);
    drive.batch(30, 29.9);
    EXPECT_NEAR(drive.moved(29.9, 30.1), 0.6, 1e-4) << "a clock that runs backwards";
}

TEST(ShapeFeed, TheLastMomentHasKeys) {
    Drive drive;
    drive.batch(2);
    EXPECT_NEAR(static_cast<double>(drive.batch(max_scene_time)), 0.3 * body_keys_per_second, 3);
}

TEST(ShapeFeed, ManyBodiesAfterAPauseFitABatch) {
    Drive drive;
    drive.bodies.frames.assign(4097, 0); // as many as there may be
    EXPECT_LE(drive.batch(1, 1.5), max_batch_keys);
    for (double const time : {1.5, 2.0, 2.9, 5.0, 5.1, 6.0, 7.0, 7.5}) {
        EXPECT_LE(drive.batch(time), max_batch_keys) << time;
    }
}

TEST(ShapeFeed, StillScenesHaveNoTracks) {
    Drive drive;
    drive.bodies = find_bodies(drive.scene, {});
    EXPECT_EQ(drive.batch(1), 0u);
}

} // namespace
} // namespace framelet
