#include "client/core/camera/camera_track.h"

#include <cmath>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

namespace framelet {
namespace {

constexpr double key_seconds = 1.0 / body_keys_per_second;

/// A camera that goes and turns steadily, and is elsewhere from key `cut` on.
BodyTrack steady_track(int keys, int cut, Vec3 step, float turn, Vec3 leap, float leap_turn) {
    BodyTrack track{camera_body(0), 100, {}};
    for (int i = 0; i < keys; ++i) {
        auto const steps = static_cast<float>(i);
        bool const is_cut = i >= cut;
        track.keys.push_back({steps * step + (is_cut ? leap : Vec3(0)),
                              glm::angleAxis(steps * turn + (is_cut ? leap_turn : 0), Vec3(0, 1, 0)), Vec3(1)});
    }
    return track;
}

SceneTime time_of(double key) {
    return (100 + key) * key_seconds;
}

TEST(CameraTrack, GoesBetweenItsKeysAndKeepsTheLens) {
    BodyTrack const track = steady_track(20, 100, {0.1f, 0, 0}, 0.02f, {}, 0);
    Camera like;
    like.vertical_extent = 0.3f;
    Camera const at = camera_at(track, time_of(4.5), like);
    EXPECT_NEAR(at.position.x, 0.45f, 1e-5f);
    EXPECT_NEAR(std::abs(glm::dot(at.orientation, glm::angleAxis(0.09f, Vec3(0, 1, 0)))), 1, 1e-6f);
    EXPECT_EQ(at.vertical_extent, 0.3f);
    EXPECT_EQ(camera_at(track, time_of(-3), like).position.x, 0);
}

TEST(CameraTrack, DoesNotFlyWhereTheCameraCuts) {
    Camera const like;
    for (auto const& [leap, turn] : {std::pair(Vec3(5, 0, 0), 0.0f), std::pair(Vec3(0), 1.0f)}) {
        BodyTrack const track = steady_track(20, 10, {0.1f, 0, 0}, 0.02f, leap, turn);
        EXPECT_NEAR(camera_at(track, time_of(9.9), like).position.x, 0.9f, 1e-5f);
        EXPECT_NEAR(camera_at(track, time_of(10.001), like).position.x, 1 + leap.x, 1e-3f);
        EXPECT_NEAR(camera_at(track, time_of(8.5), like).position.x, 0.85f, 1e-5f);
        EXPECT_NEAR(camera_at(track, time_of(10.5), like).position.x, 1.05f + leap.x, 1e-5f);
    }
}

TEST(CameraTrack, ACutAtItsEndIsNotGoneOnWith) {
    BodyTrack const track = steady_track(11, 10, {0.1f, 0, 0}, 0, {5, 0, 0}, 0);
    EXPECT_NEAR(camera_at(track, time_of(12), Camera()).position.x, 6, 1e-5f);
}

TEST(CameraTrack, AStartFromRestIsNoCut) {
    BodyTrack track = steady_track(20, 100, {0, 0, 0}, 0, {}, 0);
    for (std::size_t i = 10; i < 20; ++i) {
        track.keys[i].translation.x = 0.2f * static_cast<float>(i - 9);
    }
    EXPECT_NEAR(camera_at(track, time_of(9.5), Camera()).position.x, 0.1f, 1e-5f);
}

} // namespace
} // namespace framelet
