#include "common/camera.h"

#include <cmath>

#include <gtest/gtest.h>

namespace framelet {
namespace {

Vec3 direction_at(ViewRays const& rays, float x, float y) {
    return rays.direction + x * rays.direction_dx + y * rays.direction_dy;
}

TEST(Camera, LooksDownMinusZWithXRightAndYUp) {
    Camera camera;
    camera.vertical_extent = 1.57079633f; // 90 degrees
    ViewRays const rays = make_view_rays(camera, {200, 100});
    Vec3 const middle = direction_at(rays, 100, 50);
    EXPECT_NEAR(glm::length(middle - Vec3(0, 0, -1)), 0, 1e-6);
    Vec3 const top_right = direction_at(rays, 200, 0);
    EXPECT_NEAR(top_right.x, 2, 1e-5);
    EXPECT_NEAR(top_right.y, 1, 1e-5);
    EXPECT_NEAR(top_right.z, -1, 1e-6);
}

TEST(Camera, RayParameterIsViewDepth) {
    Camera const camera = look_at({3, 4, 5}, {0, 1, -2}, {0, 1, 0}, 0.9f);
    ViewRays const rays = make_view_rays(camera, {640, 480});
    for (float x : {0.0f, 123.0f, 640.0f}) {
        for (float y : {0.0f, 77.0f, 480.0f}) {
            EXPECT_NEAR(glm::dot(direction_at(rays, x, y), camera.forward()), 1, 1e-5);
        }
    }
}

TEST(Camera, OrthographicRaysAreParallel) {
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.vertical_extent = 4;
    ViewRays const rays = make_view_rays(camera, {100, 50});
    EXPECT_EQ(direction_at(rays, 0, 0), direction_at(rays, 100, 50));
    Vec3 const corner = rays.origin;
    EXPECT_NEAR(corner.x, -4, 1e-5);
    EXPECT_NEAR(corner.y, 2, 1e-5);
}

TEST(Camera, LookAtSurvivesAnUpAxisAlongTheView) {
    for (Vec3 const target : {Vec3(0, -5, 0), Vec3(0, 5, 0), Vec3(7, 0, 0)}) {
        Camera const camera = look_at({0, 0, 0}, target, target, 1);
        EXPECT_TRUE(is_valid(camera));
        EXPECT_NEAR(glm::length(camera.forward() - glm::normalize(target)), 0, 1e-5);
    }
}

TEST(Camera, RefusesWhatIsNotACamera) {
    Camera camera;
    EXPECT_TRUE(is_valid(camera));
    camera.position.x = NAN;
    EXPECT_FALSE(is_valid(camera));
    camera = {};
    camera.orientation = Quat(0, 0, 0, 0);
    EXPECT_FALSE(is_valid(camera));
    camera = {};
    camera.vertical_extent = INFINITY;
    EXPECT_FALSE(is_valid(camera));
    camera.vertical_extent = NAN;
    EXPECT_FALSE(is_valid(camera));
}

} // namespace
} // namespace framelet
