#include "client/core/camera/camera_controller.h"

#include <cmath>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace framelet {
namespace {

Viewport const viewport{800, 600};

/// A scene of this diagonal around the origin and a camera that sees all of it.
struct Stage {
    Bounds scene;
    Camera home;

    explicit Stage(float diagonal) {
        Vec3 const half = Vec3(1, 1, 1) * (0.5f * diagonal / std::sqrt(3.0f));
        scene.include(-half);
        scene.include(half);
        home = look_at(Vec3(0, 0.3f, 1) * diagonal, Vec3(0, 0, 0), Vec3(0, 1, 0), 0.8f);
    }
};

/// The tests run for scenes from the size of a watch to that of a landscape.
class CameraControllerOfSize : public testing::TestWithParam<float> {};
INSTANTIATE_TEST_SUITE_P(Sizes, CameraControllerOfSize, testing::Values(0.03f, 1.0f, 50.0f, 2000.0f));

TEST_P(CameraControllerOfSize, OrbitKeepsDistanceAimAndHorizon) {
    float const size = GetParam();
    Stage const stage(size);
    CameraController controller(stage.home, stage.scene);
    float const distance = glm::length(stage.home.position);
    for (int i = 0; i < 500; ++i) {
        controller.orbit({7, i % 60 < 30 ? 9 : -9}, viewport);
        Camera const& camera = controller.camera();
        ASSERT_TRUE(is_valid(camera));
        EXPECT_NEAR(glm::length(camera.position), distance, 2e-3f * size);
        EXPECT_GT(glm::dot(camera.forward(), glm::normalize(-camera.position)), 0.9999f);
        EXPECT_NEAR(camera.right().y, 0, 1e-3f);
        EXPECT_GE(camera.up().y, -1e-4f);
    }
}

TEST_P(CameraControllerOfSize, PanMovesThePointUnderThePointerWithIt) {
    float const size = GetParam();
    Stage const stage(size);
    CameraController controller(stage.home, stage.scene);
    controller.pan({100, 40}, viewport);
    // The origin is seen there now: it was in the middle.
    Camera const& camera = controller.camera();
    Vec3 const from_camera = -camera.position;
    float const depth = glm::dot(from_camera, camera.forward());
    float const pixel = 2 * std::tan(0.5f * camera.vertical_extent) * depth / 600;
    EXPECT_NEAR(glm::dot(from_camera, camera.right()) / pixel, 100, 0.1f);
    EXPECT_NEAR(-glm::dot(from_camera, camera.up()) / pixel, 40, 0.1f);
    EXPECT_EQ(camera.orientation, stage.home.orientation);
}

TEST_P(CameraControllerOfSize, DollyNearsButNeverPasses) {
    Stage const stage(GetParam());
    CameraController controller(stage.home, stage.scene);
    float distance = glm::length(stage.home.position);
    controller.dolly(1);
    EXPECT_NEAR(glm::length(controller.camera().position), 0.9f * distance, 1e-3f * distance);
    controller.dolly(-1);
    EXPECT_NEAR(glm::length(controller.camera().position), distance, 1e-3f * distance);
    for (int i = 0; i < 300; ++i) {
        controller.dolly(1);
        ASSERT_TRUE(is_valid(controller.camera()));
        ASSERT_GT(glm::dot(controller.camera().forward(), stage.home.forward()), 0.999f);
    }
    EXPECT_LT(glm::length(controller.camera().position), 1e-3f * distance);
    controller.dolly(-500);
    EXPECT_TRUE(is_valid(controller.camera()));
}

TEST_P(CameraControllerOfSize, FlyingIsIndependentOfTheFrameRateAndScalesWithTheScene) {
    float const size = GetParam();
    Stage const stage(size);
    CameraController once(stage.home, stage.scene);
    CameraController often(stage.home, stage.scene);
    FlyInput const forward{{0, 0, -1}, {0, 0}, false};
    once.fly(forward, 1);
    for (int i = 0; i < 60; ++i) {
        often.fly(forward, 1.0 / 60);
    }
    Vec3 const way = once.camera().position - stage.home.position;
    float const expected = size <= 30 ? size / 8 : std::sqrt(30 * size) / 8;
    EXPECT_NEAR(glm::length(way), expected, 1e-3f * size);
    EXPECT_GT(glm::dot(glm::normalize(way), stage.home.forward()), 0.9999f);
    EXPECT_LT(glm::distance(once.camera().position, often.camera().position), 1e-4f * size);
}

TEST_P(CameraControllerOfSize, TheHeadTurnsInPlaceIndependentlyOfTheFrameRate) {
    Stage const stage(GetParam());
    CameraController once(stage.home, stage.scene);
    CameraController often(stage.home, stage.scene);
    FlyInput const right{{0, 0, 0}, {0.5f, 0}, true};
    once.fly(right, 1);
    for (int i = 0; i < 60; ++i) {
        often.fly(right, 1.0 / 60);
    }
    EXPECT_EQ(once.camera().position, stage.home.position);
    EXPECT_GT(glm::dot(once.camera().forward(), stage.home.right()), 0.6f); // an eighth of a turn
    EXPECT_GT(glm::dot(once.camera().forward(), stage.home.forward()), 0.6f);
    EXPECT_GT(glm::dot(once.camera().forward(), often.camera().forward()), 0.9999f);
    once.fly({{0, 0, 0}, {0, 2}, false}, 0.1); // as fast as at 1
    EXPECT_NEAR(std::asin(once.camera().forward().y) - std::asin(often.camera().forward().y), -0.157f, 1e-3f);
}

TEST_P(CameraControllerOfSize, HalfADeflectionFliesHalfAsFast) {
    Stage const stage(GetParam());
    CameraController whole(stage.home, stage.scene);
    CameraController half(stage.home, stage.scene);
    whole.fly({{0, 0, -1}, {0, 0}, false}, 1);
    half.fly({{0, 0, -0.5f}, {0, 0}, false}, 2);
    EXPECT_LT(glm::distance(whole.camera().position, half.camera().position), 1e-4f * GetParam());
}

/// The point in camera space.
Vec3 seen_from(Camera const& camera, Vec3 point) {
    return glm::conjugate(camera.orientation) * (point - camera.position);
}

TEST_P(CameraControllerOfSize, WhatTheHandsTurnAndNearStaysUnderThePointer) {
    float const size = GetParam();
    Stage const stage(size);
    CameraController controller(stage.home, stage.scene);
    Vec3 const point = Vec3(0.2f, -0.1f, 0.3f) * size;
    Vec3 const seen = seen_from(stage.home, point);
    controller.set_pivot(point);
    EXPECT_EQ(controller.camera(), stage.home);
    for (int i = 0; i < 100; ++i) {
        controller.orbit({7, i % 60 < 30 ? 9 : -9}, viewport);
        ASSERT_LT(glm::distance(seen_from(controller.camera(), point), seen), 1e-3f * size);
        ASSERT_NEAR(controller.camera().right().y, 0, 1e-3f);
    }
    EXPECT_GT(glm::distance(controller.camera().position, stage.home.position), 0.1f * size);
    controller.dolly(3);
    EXPECT_LT(glm::distance(seen_from(controller.camera(), point), 0.729f * seen), 1e-3f * size);
}

TEST_P(CameraControllerOfSize, WhatNoPivotCanBeIsNone) {
    float const size = GetParam();
    Stage const stage(size);
    CameraController controller(stage.home, stage.scene);
    Vec3 const before = controller.pivot();
    controller.set_pivot(stage.home.position - stage.home.forward() * size); // behind
    controller.set_pivot(stage.home.position + stage.home.forward() * (1e5f * size));
    controller.set_pivot(Vec3(NAN));
    EXPECT_EQ(controller.pivot(), before);
}

TEST_P(CameraControllerOfSize, FitDoesNotLeadIntoTheGround) {
    float const size = GetParam();
    Bounds ground;
    ground.include(Vec3(-0.5f, 0, -0.5f) * size);
    ground.include(Vec3(0.5f, 0.01f, 0.5f) * size);
    Camera home = look_at(Vec3(0, 0.02f, 0.3f) * size, Vec3(0, 0.05f, 0) * size, Vec3(0, 1, 0), 0.8f);
    CameraController controller(home, ground);
    controller.fit(viewport, 40);
    EXPECT_GT(controller.camera().position.y, 0);
    EXPECT_NEAR(controller.camera().right().y, 0, 1e-3f);
    controller.look_along({0, 1, 0}, {0, 0, 1});
    controller.fit(viewport, 40);
    EXPECT_LT(controller.camera().position.y, 0) << "who wants to look from below does";
}

TEST_P(CameraControllerOfSize, WhatLiesBehindAllOfTheSceneIsNotTakenHoldOf) {
    float const size = GetParam();
    Stage const stage(size);
    CameraController const controller(stage.home, stage.scene);
    Camera amid = stage.home;
    amid.position = {0, 0, 0};
    for (Camera const& camera : {stage.home, amid}) {
        Vec3 const corner = Vec3(0.5f, -0.5f, -0.5f) * stage.scene.size();
        EXPECT_TRUE(controller.can_hold(camera, corner));
        EXPECT_FALSE(controller.can_hold(camera, camera.position + 3 * size * camera.forward())) << "as a sky does";
    }
    EXPECT_TRUE(CameraController(stage.home, {}).can_hold(stage.home, stage.home.position + stage.home.forward()));
}

TEST_P(CameraControllerOfSize, FocusTurnsToThePointAndGoesHalfOfTheWay) {
    float const size = GetParam();
    Stage const stage(size);
    CameraController controller(stage.home, stage.scene);
    Vec3 const point = Vec3(0.2f, -0.1f, 0.3f) * size;
    controller.focus(point);
    Camera const& camera = controller.camera();
    float const distance = glm::distance(stage.home.position, point);
    EXPECT_LT(glm::distance(seen_from(camera, point), Vec3(0, 0, -0.5f * distance)), 1e-3f * size);
    EXPECT_LT(glm::distance(controller.pivot(), point), 1e-3f * size);
    EXPECT_NEAR(camera.right().y, 0, 1e-3f);
    for (int i = 0; i < 100; ++i) {
        controller.focus(point);
        ASSERT_TRUE(is_valid(camera));
    }
}

TEST_P(CameraControllerOfSize, FitShowsAllOfTheSceneWithAMarginAndClearOfTheBar) {
    Stage const stage(GetParam());
    for (Projection const projection : {Projection::perspective, Projection::orthographic}) {
        Camera home = stage.home;
        home.projection = projection;
        CameraController controller(home, stage.scene);
        controller.fly({{1, 1, -1}, {0, 0}, true}, 3);
        for (Viewport const size : {viewport, Viewport{200, 600}}) {
            for (int const bar : {0, 60}) {
                controller.fit(size, bar);
                Camera const& camera = controller.camera();
                EXPECT_EQ(camera.orientation, home.orientation);
                // Pixels between the scene and the edges.
                float left = 1e9f, right = 1e9f, above = 1e9f, below = 1e9f;
                for (int i = 0; i < 8; ++i) {
                    Vec3 const side(i & 1, i >> 1 & 1, i >> 2);
                    Vec3 const corner = seen_from(camera, stage.scene.lower + side * stage.scene.size());
                    EXPECT_LT(corner.z, 0);
                    float const edge = projection == Projection::perspective
                                           ? -corner.z * std::tan(0.5f * camera.vertical_extent)
                                           : 0.5f * camera.vertical_extent;
                    auto const half = 0.5f * static_cast<float>(size.height);
                    float const x = 0.5f * static_cast<float>(size.width) + corner.x / edge * half;
                    float const y = half - corner.y / edge * half;
                    left = std::min(left, x);
                    right = std::min(right, static_cast<float>(size.width) - x);
                    above = std::min(above, y);
                    below = std::min(below, static_cast<float>(size.height - bar) - y);
                }
                float const margin = 0.04f * static_cast<float>(std::min(size.width, size.height));
                float const tightest = std::min({left, right, above, below});
                EXPECT_NEAR(tightest, margin, 0.05f * margin) << "and no smaller than that";
                EXPECT_NEAR(left, right, 0.1f * left);
                EXPECT_NEAR(above, below, 0.1f * above) << "about in the middle of what is free";
                EXPECT_LT(glm::distance(controller.pivot(), stage.scene.center()), 1e-3f * GetParam());
            }
        }
    }
}

TEST(CameraController, WhatIsFlatOrAWindowOfNearlyNothingIsFittedToo) {
    Bounds flat;
    flat.include({-1, 0, -1});
    flat.include({1, 0, 1});
    for (Vec3 const forward : {Vec3(0, 0, -1), Vec3(0, -1, 0), Vec3(0, 1, 0)}) {
        for (Viewport const size : {viewport, Viewport{30, 20}, Viewport{1, 1}, Viewport{2000, 1}}) {
            CameraController controller(Camera{}, flat);
            for (int i = 0; i < 2; ++i) {
                controller.look_along(forward, {0, 0, -1});
                controller.fit(size, 34);
                EXPECT_TRUE(is_valid(controller.camera()));
                EXPECT_LT(seen_from(controller.camera(), {1, 0, 1}).z, 0);
                controller.toggle_projection();
            }
        }
    }
}

TEST(CameraController, LooksToWhereThePointerGoes) {
    CameraController controller(look_at({0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 0.8f), {{-1, -1, -1}, {1, 1, 1}});
    Vec3 const position = controller.camera().position;
    controller.look({100, 0}, {200, 100}); // a quarter turn
    EXPECT_LT(glm::distance(controller.camera().forward(), Vec3(1, 0, 0)), 1e-5f);
    controller.look({0, 25}, {200, 100});
    EXPECT_LT(controller.camera().forward().y, -0.3f);
    EXPECT_EQ(controller.camera().position, position);
}

TEST(CameraController, WhatTheHandsDoNotMoveStaysWhereItIsToTheLastBit) {
    Stage const stage(20000);
    CameraController controller(stage.home, stage.scene);
    controller.fit(viewport);
    Vec3 const position = controller.camera().position;
    for (int i = 0; i < 20; ++i) {
        controller.look({7, 3}, viewport);
        controller.orbit({0, 0}, viewport);
        controller.pan({0, 0}, viewport);
        controller.dolly(0);
    }
    EXPECT_EQ(controller.camera().position, position);
}

TEST(CameraController, TheWheelMakesFlyingFasterWithinBounds) {
    CameraController controller(look_at({0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 0.8f), {{-1, -1, -1}, {1, 1, 1}});
    float const before = controller.fly_speed();
    controller.change_speed(3);
    EXPECT_NEAR(controller.fly_speed(), 1.953125f * before, 1e-4f * before);
    controller.change_speed(-1000);
    controller.fly({{0, 0, -1}, {0, 0}, false}, 1);
    EXPECT_NEAR(controller.camera().position.z, -controller.fly_speed(), 1e-6f);
    EXPECT_GT(controller.fly_speed(), 0);
}

TEST(CameraController, AmidALandscapeTheViewTurnsAroundSomethingNear) {
    Stage const stage(2000);
    Camera const street = look_at({50, 2, 100}, {60, 1, 100}, {0, 1, 0}, 0.8f);
    CameraController controller(street, stage.scene);
    EXPECT_LT(glm::distance(controller.pivot(), street.position), 30);
    EXPECT_GT(glm::distance(controller.pivot(), street.position), 2);
}

TEST(CameraController, ResetGoesHome) {
    Stage const stage(3);
    CameraController controller(stage.home, stage.scene);
    controller.orbit({30, 20}, viewport);
    controller.pan({30, 20}, viewport);
    controller.dolly(3);
    controller.fly({{1, 1, 1}, {0, 0}, true}, 2);
    EXPECT_NE(controller.camera(), stage.home);
    controller.reset();
    EXPECT_EQ(controller.camera(), stage.home);
}

TEST(CameraController, DraggingRightTurnsTheSceneRight) {
    Stage const stage(2);
    CameraController controller(stage.home, stage.scene);
    controller.orbit({50, 0}, viewport);
    EXPECT_LT(controller.camera().position.x, 0); // the camera goes left around it
    controller.reset();
    controller.orbit({0, 50}, viewport);
    EXPECT_GT(controller.camera().position.y, stage.home.position.y); // and up over it
}

TEST(CameraController, ASceneWithoutExtentIsNoTrouble) {
    CameraController controller(Camera{}, Bounds{});
    controller.orbit({50, 50}, viewport);
    controller.dolly(2);
    controller.pan({5, 5}, viewport);
    controller.fly({{0, 0, -1}, {0, 0}, false}, 1);
    EXPECT_TRUE(is_valid(controller.camera()));
}

TEST(CameraController, HoweverFarItGoesItStaysACamera) {
    Bounds huge;
    huge.include(Vec3(-3e38f));
    huge.include(Vec3(3e38f));
    CameraController controller(Camera{}, huge);
    for (int i = 0; i < 1000; ++i) {
        controller.fly({{1, 0.5f, -1}, {0, 0}, true}, 1e6);
        controller.dolly(-20);
        controller.pan({1e6f, 1e6f}, viewport);
        controller.orbit({31, 7}, viewport);
        ASSERT_TRUE(is_valid(controller.camera()));
    }
}

TEST(CameraController, AViewStraightDownCanBeTakenOver) {
    Stage const stage(2);
    CameraController controller(stage.home, stage.scene);
    controller.set_camera(look_at({0, 5, 0}, {0, 0, 0}, {0, 0, -1}, 0.8f));
    for (int i = 0; i < 100; ++i) {
        controller.orbit({11, 3}, viewport);
        ASSERT_TRUE(is_valid(controller.camera()));
        EXPECT_GE(controller.camera().up().y, -1e-3f);
    }
}

TEST(CameraController, OrthographicViewsZoom) {
    Stage const stage(2);
    Camera camera = stage.home;
    camera.projection = Projection::orthographic;
    camera.vertical_extent = 4;
    CameraController controller(camera, stage.scene);
    controller.dolly(1);
    EXPECT_NEAR(controller.camera().vertical_extent, 3.6f, 1e-4f);
    EXPECT_EQ(controller.camera().position, camera.position);
    controller.pan({150, 0}, viewport);
    EXPECT_NEAR(glm::distance(controller.camera().position, camera.position), 0.9f, 1e-3f);
}

TEST_P(CameraControllerOfSize, LooksAlongAnAxisAtWhatItLookedAt) {
    float const size = GetParam();
    Stage const stage(size);
    CameraController controller(stage.home, stage.scene);
    Vec3 const point = Vec3(0.1f, 0.05f, 0.02f) * size;
    controller.set_pivot(point);
    float const distance = glm::length(point - stage.home.position);
    struct View {
        Vec3 forward, up, right;
    };
    for (auto const& [forward, up, right] : {View{{0, 0, -1}, {0, 1, 0}, {1, 0, 0}},
                                             {{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}},
                                             {{0, -1, 0}, {0, 0, -1}, {1, 0, 0}}}) {
        controller.look_along(forward, up);
        Camera const& camera = controller.camera();
        ASSERT_TRUE(is_valid(camera));
        EXPECT_LT(glm::length(camera.forward() - forward), 1e-4f);
        EXPECT_LT(glm::length(camera.right() - right), 1e-4f);
        EXPECT_LT(glm::length(camera.position + distance * forward - point), 1e-3f * size);
    }
}

TEST_P(CameraControllerOfSize, ProjectionsShowThePivotAtItsPlaceAndInItsSize) {
    float const size = GetParam();
    Stage const stage(size);
    CameraController controller(stage.home, stage.scene);
    controller.set_pivot(Vec3(0.1f, 0.05f, 0.02f) * size);
    controller.toggle_projection();
    Camera const flat = controller.camera();
    ASSERT_TRUE(is_valid(flat));
    ASSERT_EQ(flat.projection, Projection::orthographic);
    EXPECT_EQ(flat.position, stage.home.position);
    float const depth = glm::dot(controller.pivot() - flat.position, flat.forward());
    EXPECT_NEAR(flat.vertical_extent, 2 * std::tan(0.4f) * depth, 1e-3f * size);
    controller.toggle_projection();
    EXPECT_EQ(controller.camera().projection, Projection::perspective);
    EXPECT_FLOAT_EQ(controller.camera().vertical_extent, 0.8f);
    EXPECT_LT(glm::length(controller.camera().position - stage.home.position), 1e-3f * size);
    controller.toggle_projection();
    controller.dolly(1); // makes the picture's height a tenth less, which perspective does by going nearer
    controller.toggle_projection();
    float const nearer = glm::dot(controller.pivot() - controller.camera().position, flat.forward());
    EXPECT_NEAR(nearer, 0.9f * depth, 1e-3f * size);
}

TEST(CameraController, TheSpeedOfFlyingCanBeSetAsItWas) {
    Bounds const scene{{-1, -1, -1}, {1, 1, 1}};
    CameraController before({}, scene);
    EXPECT_EQ(before.speed_factor(), 1);
    before.change_speed(3);
    EXPECT_GT(before.speed_factor(), 1);
    CameraController after({}, scene);
    after.set_speed_factor(before.speed_factor());
    EXPECT_EQ(after.fly_speed(), before.fly_speed());
    after.set_speed_factor(1e9f);
    EXPECT_EQ(after.speed_factor(), CameraController::most_speed_factor);
}

} // namespace
} // namespace framelet
