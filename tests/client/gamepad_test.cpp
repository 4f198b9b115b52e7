#include "client/window/gamepad.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(Gamepad, LetGoItDoesNothing) {
    EXPECT_FALSE(fly_input({}).moving());
    GamepadAxes const worn{{0.1f, -0.1f}, {-0.14f, 0}, -0.9f, -0.85f, true};
    EXPECT_FALSE(fly_input(worn).moving());
}

TEST(Gamepad, SticksAndTriggersHaveTheirDirections) {
    GamepadAxes axes;
    axes.left_stick = {0, -1};
    EXPECT_EQ(fly_input(axes).direction, Vec3(0, 0, -1)); // pushed away: forward
    axes.left_stick = {1, 0};
    EXPECT_EQ(fly_input(axes).direction, Vec3(1, 0, 0));
    axes.left_stick = {0, 0};
    axes.right_trigger = 1;
    EXPECT_EQ(fly_input(axes).direction, Vec3(0, 1, 0));
    axes.left_trigger = 1;
    EXPECT_EQ(fly_input(axes).direction, Vec3(0, 0, 0));
    axes.right_trigger = -1;
    EXPECT_EQ(fly_input(axes).direction, Vec3(0, -1, 0));
    axes.left_trigger = -1;
    axes.right_stick = {-1, 0};
    EXPECT_EQ(fly_input(axes).direction, Vec3(0, 0, 0));
    EXPECT_EQ(fly_input(axes).turn, Vec2(-1, 0));
    EXPECT_FALSE(fly_input(axes).fast);
    axes.bumper = true;
    EXPECT_TRUE(fly_input(axes).fast);
}

TEST(Gamepad, MoreIsFasterAndAStickInACornerNoFasterThanAtItsEdge) {
    float last = 0;
    for (float deflection = 0.2f; deflection <= 1; deflection += 0.1f) {
        GamepadAxes const axes{{0.6f * deflection, 0.8f * deflection}, {0, deflection}, -1, 2 * deflection - 1, false};
        FlyInput const input = fly_input(axes);
        EXPECT_GT(input.turn.y, last);
        EXPECT_NEAR(glm::length(Vec2(input.direction.x, input.direction.z)), input.turn.y, 1e-5f);
        EXPECT_NEAR(input.direction.x / input.direction.z, 0.75f, 1e-4f);
        EXPECT_GT(input.direction.y, 0);
        last = input.turn.y;
    }
    GamepadAxes const corner{{1, 1}, {-1, 1}, -1, -1, false};
    EXPECT_NEAR(glm::length(fly_input(corner).direction), 1, 1e-5f);
    EXPECT_NEAR(glm::length(fly_input(corner).turn), 1, 1e-5f);
}

TEST(Gamepad, AddsToTheKeys) {
    FlyInput const keys{{1, 0, -1}, {0, 0}, true};
    GamepadAxes axes;
    axes.right_stick = {0, 1};
    FlyInput const both = keys + fly_input(axes);
    EXPECT_EQ(both.direction, keys.direction);
    EXPECT_EQ(both.turn, Vec2(0, 1));
    EXPECT_TRUE(both.fast);
}

} // namespace
} // namespace framelet
