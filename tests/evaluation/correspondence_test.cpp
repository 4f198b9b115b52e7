#include <cmath>

#include <gtest/gtest.h>

#include "tests/evaluation/correspondence/exact_motion.h"
#include "tests/evaluation/correspondence/position_code.h"

namespace framelet::bench {
namespace {

TEST(PositionCode, ComesBackFromInterpolatedSquares) {
    for (float position = 0.5f; position < 200; position += 0.13f) {
        int const before = static_cast<int>(std::floor(position - 0.5f));
        float const weight = position - 0.5f - static_cast<float>(before);
        for (float const off : {-6.0f, -0.3f, 0.0f, 0.2f, 5.0f}) {
            float const near = position + off;
            int const shift = steady_shift(near);
            float const a = position_byte(before, shift);
            float const b = position_byte(before + 1, shift);
            EXPECT_NEAR(position_of(a * a + weight * (b * b - a * a), shift, near), position, 2e-3f) << near;
        }
    }
}

TEST(ExactMotion, FollowsCameraAndBody) {
    // Body 1 is carried by node 0; it moves by a metre to the right while the camera stands.
    SceneBodies bodies;
    bodies.frames = {none, 0};
    ScenePose const before{0, {Mat4(1)}, {}};
    ScenePose after{0.5, {Mat4(1)}, {}};
    after.world_from_node[0][3] = Vec4(1, 0, 0, 1);
    Viewport const viewport{100, 100};
    Camera const camera{.vertical_extent = 2 * std::atan(0.5f)}; // at depth 1 m the picture is a metre wide
    Camera moved = camera;
    moved.position.x = 1;
    ExactMotion const body(bodies, {before, camera}, {after, camera}, viewport);
    EXPECT_NEAR(body.shown({50, 50}, 0.25f, 1, {}).pixel.x, 75, 1e-3f);
    EXPECT_NEAR(body.shown({50, 50}, 0.25f, 0, {}).pixel.x, 50, 1e-3f);
    EXPECT_NEAR(body.shown({50, 50}, 0.25f, 0, {Vec3(0, 2, 0)}).pixel.y, 25, 1e-3f);
    ExactMotion const eye(bodies, {before, camera}, {before, moved}, viewport);
    EXPECT_NEAR(eye.shown({50, 50}, 0.25f, 0, {}).pixel.x, 25, 1e-3f);
    EXPECT_NEAR(eye.shown({50, 50}, 0.25f, 0, {}).inverse_depth, 0.25f, 1e-6f);
    EXPECT_NEAR(eye.shown({50, 50}, 0, 0, {}).pixel.x, 50, 1e-3f);
}

} // namespace
} // namespace framelet::bench
