#include "server/sampling/field/view_motion.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace framelet {
namespace {

constexpr Viewport viewport{800, 600};
constexpr float most = 128;

float displacement(Camera const& from, Camera const& to, Vec2 pixel, float inverse_depth) {
    return view_displacement(make_view_rays(from, viewport), make_view_rays(to, viewport), pixel, inverse_depth, most);
}

Camera orthographic(float height) {
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.vertical_extent = height;
    return camera;
}

Quat turned(float radians, Vec3 axis) {
    return glm::angleAxis(radians, axis);
}

TEST(ViewMotion, StandingStillIsNoMotion) {
    for (Camera const& camera : {Camera{}, orthographic(3)}) {
        for (float const inverse_depth : {0.0f, 0.1f, 10.0f}) {
            EXPECT_NEAR(displacement(camera, camera, {123, 45}, inverse_depth), 0, 1e-2f);
        }
    }
}

/// A step aside by s metres moves what is d metres away by f s / d pixels, f = height / (2 tan(fov / 2)).
TEST(ViewMotion, PerspectiveTranslation) {
    Camera const from;
    float const focal = 600 / (2 * std::tan(0.4f));
    for (Vec3 const step : {Vec3(0.01f, 0, 0), Vec3(0, -0.02f, 0)}) {
        Camera to = from;
        to.position += step;
        for (float const depth : {1.0f, 10.0f, 1000.0f}) {
            for (Vec2 const pixel : {Vec2(400, 300), Vec2(10, 590)}) {
                EXPECT_NEAR(displacement(from, to, pixel, 1 / depth),
                            focal * (std::abs(step.x) + std::abs(step.y)) / depth, 0.01f);
            }
        }
        EXPECT_NEAR(displacement(from, to, {10, 590}, 0), 0, 0.01f) << "what is infinitely far stays";
    }
    // A step ahead by a tenth of the way moves what is p pixels from the middle by p / 9.
    Camera ahead = from;
    ahead.position.z -= 1;
    EXPECT_NEAR(displacement(from, ahead, {490, 300}, 0.1f), 10, 0.01f);
    EXPECT_NEAR(displacement(from, ahead, {400, 300}, 0.1f), 0, 0.01f);
}

TEST(ViewMotion, PerspectiveRotation) {
    Camera const from;
    float const focal = 600 / (2 * std::tan(0.4f));
    for (float const angle : {0.001f, 0.01f, 0.1f}) {
        Camera to = from;
        to.orientation = turned(angle, Vec3(0, 1, 0));
        for (float const inverse_depth : {0.0f, 0.01f, 2.0f}) { // about the own axis: the same at any depth
            EXPECT_NEAR(displacement(from, to, {400, 300}, inverse_depth), focal * std::tan(angle), 0.05f);
        }
        to.orientation = turned(angle, Vec3(0, 0, 1)); // roll: a chord
        EXPECT_NEAR(displacement(from, to, {500, 300}, 0), 2 * 100 * std::sin(angle / 2), 0.05f);
    }
}

TEST(ViewMotion, WhatIsBehindIsGone) {
    Camera const from;
    Camera to = from;
    to.orientation = turned(3.0f, Vec3(0, 1, 0));
    EXPECT_EQ(displacement(from, to, {400, 300}, 0), most);
    EXPECT_EQ(displacement(from, to, {400, 300}, 1), most);
    to = from;
    to.position.z -= 2; // past what is a metre away
    EXPECT_EQ(displacement(from, to, {420, 300}, 1), most);
    EXPECT_LT(displacement(from, to, {420, 300}, 0.1f), most);
    Camera const flat = orthographic(2);
    to = flat;
    to.position.z -= 2;
    EXPECT_EQ(displacement(flat, to, {420, 300}, 1), most);
    EXPECT_NEAR(displacement(flat, to, {420, 300}, 0.1f), 0, 0.01f);
}

TEST(ViewMotion, Orthographic) {
    Camera const from = orthographic(3); // 200 pixels a metre
    Camera to = from;
    to.position.x += 0.1f;
    for (float const inverse_depth : {0.05f, 1.0f}) {
        EXPECT_NEAR(displacement(from, to, {30, 40}, inverse_depth), 20, 0.01f);
    }
    to = from;
    to.vertical_extent = 6; // half as large about the middle
    EXPECT_NEAR(displacement(from, to, {500, 300}, 0.1f), 50, 0.01f);
    to = from;
    to.orientation = turned(0.1f, Vec3(0, 1, 0));
    EXPECT_NEAR(displacement(from, to, {400, 300}, 1.0f), 200 * std::sin(0.1f), 0.05f);
}

TEST(ViewMotion, NeverExceedsTheMost) {
    for (Camera const& from : {Camera{}, orthographic(3)}) {
        for (int n = 0; n < 1000; ++n) {
            Camera to = from;
            auto const t = static_cast<float>(n);
            to.position = Vec3(std::sin(t), std::cos(3 * t), std::sin(7 * t)) * 5.0f;
            to.orientation = turned(t, glm::normalize(Vec3(std::sin(t), 1, std::cos(2 * t))));
            for (float const inverse_depth : {0.0f, 1e-6f, 1.0f, 1e6f}) {
                float const found = displacement(from, to, {static_cast<float>(n % 800), 300}, inverse_depth);
                ASSERT_GE(found, 0);
                ASSERT_LE(found, most);
            }
        }
    }
}

} // namespace
} // namespace framelet
