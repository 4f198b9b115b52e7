#include "scenes/gltf/animations.h"

#include <cmath>

#include <gtest/gtest.h>

namespace framelet {
namespace {

DQuat rotation_of(D4 const& key) {
    return {key.w, key.x, key.y, key.z};
}

TEST(Animations, SpinTakesStepsThatInterpolationFollows) {
    GltfTrack const track = spin_track({4}, {1, 0, 0}, 2 * pi * 7.25, 3);
    ASSERT_EQ(track.times.size(), 30u);
    EXPECT_EQ(track.times.front(), 0);
    EXPECT_DOUBLE_EQ(track.times.back(), 3);
    double turned = 0;
    for (std::size_t key = 1; key < track.values.size(); ++key) {
        double const cosine = glm::dot(track.values[key], track.values[key - 1]);
        EXPECT_GT(cosine, 0.7) << "at most 90 degrees, on the shorter way";
        turned += 2 * std::acos(std::min(cosine, 1.0));
    }
    EXPECT_NEAR(turned, 2 * pi * 7.25, 1e-6);
    D3 const top = rotation_of(track.values.back()) * D3(0, 1, 0);
    EXPECT_NEAR(top.z, 1, 1e-9) << "positive about +X carries the top of a wheel forward, to +Z";
}

TEST(Animations, RotationKeysStayOnTheShorterWay) {
    GltfTrack const track = rotation_track(0, 4, 40, [](double time) { return rotation_about({0, 1, 0}, 9 * time); });
    for (std::size_t key = 1; key < track.values.size(); ++key) {
        EXPECT_GT(glm::dot(track.values[key], track.values[key - 1]), 0);
    }
}

TEST(Animations, StepsAreEquallyLongAndTheLastIsHeld) {
    GltfTrack const track = step_track(0, GltfPath::translation, 6, {D4(1), D4(2), D4(3)});
    EXPECT_TRUE(track.step);
    EXPECT_EQ(track.times, (std::vector<double>{0, 2, 4, 6}));
    EXPECT_EQ(track.values.back(), D4(3));
}

TEST(LookingAt, TurnsACameraToItsTargetUpright) {
    for (D3 const target : {D3(5, 2, -3), D3(-4, -1, 7), D3(0.1, 6, 0.2), D3(-3, 0, 0)}) {
        D3 const eye(1, 1, 1);
        DQuat const turned = looking_at(eye, target);
        EXPECT_LT(glm::length(turned * D3(0, 0, -1) - glm::normalize(target - eye)), 1e-12);
        EXPECT_NEAR((turned * D3(1, 0, 0)).y, 0, 1e-12);
        EXPECT_GE((turned * D3(0, 1, 0)).y, 0);
    }
}

} // namespace
} // namespace framelet
