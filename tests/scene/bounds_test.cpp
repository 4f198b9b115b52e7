#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "server/scene/motion/animation.h"

namespace framelet {
namespace {

/// Largest |x| or |y| of a point in a 16:9 picture, 1 at its border; huge behind the camera.
float screen_extent(Camera const& camera, Vec3 const& point) {
    Vec3 const p = glm::inverse(camera.orientation) * (point - camera.position);
    if (p.z >= 0) {
        return INFINITY;
    }
    float const tangent = std::tan(0.5f * camera.vertical_extent);
    return std::max(std::abs(p.y / p.z) / tangent, std::abs(p.x / p.z) / (tangent * 16 / 9));
}

TEST(DefaultCamera, WholeBoxInViewFromTheFrontAtAnySize) {
    for (float const size : {0.03f, 1.0f, 2000.0f}) {
        for (Vec3 const shape : {Vec3(1, 1, 1), Vec3(10, 1, 1), Vec3(1, 10, 1), Vec3(0.1f, 0.1f, 10), Vec3(1, 0, 1)}) {
            Bounds box;
            box.include(Vec3(5, -3, 2) * size - 0.5f * size * shape);
            box.include(Vec3(5, -3, 2) * size + 0.5f * size * shape);
            Camera const camera = default_camera(box);
            ASSERT_TRUE(is_valid(camera));
            float largest = 0;
            for (int corner = 0; corner < 8; ++corner) {
                Vec3 const point = glm::mix(box.lower, box.upper, Vec3(corner & 1, corner >> 1 & 1, corner >> 2));
                largest = std::max(largest, screen_extent(camera, point));
            }
            EXPECT_LE(largest, 1.0f);
            EXPECT_GT(largest, 0.85f) << "fills the picture";
            EXPECT_LT(camera.forward().z, -0.5f) << "from +Z";
            EXPECT_LT(camera.forward().y, -0.1f) << "from above";
            EXPECT_GT(camera.position.x, box.center().x);
        }
    }
}

TEST(DefaultCamera, EmptyAndSinglePointAreUsable) {
    EXPECT_TRUE(is_valid(default_camera({})));
    Bounds point;
    point.include(Vec3(7, 8, 9));
    Camera const camera = default_camera(point);
    EXPECT_TRUE(is_valid(camera));
    EXPECT_GT(glm::distance(camera.position, Vec3(7, 8, 9)), 0);
}

TEST(SceneBounds, AreTightUnderRotation) {
    Scene scene;
    Primitive primitive;
    primitive.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    primitive.normals.assign(3, Vec3(0, 0, 1));
    primitive.triangles = {{0, 1, 2}};
    scene.meshes.push_back({"", {primitive}, {}});
    scene.nodes.resize(2);
    scene.nodes[0].mesh = scene.nodes[1].mesh = 0;
    scene.nodes[1].local = {{10, 0, 0}, glm::angleAxis(1.5707963f, Vec3(0, 0, 1)), {2, 2, 2}};
    Bounds const box = scene_bounds(scene, evaluate_pose(scene, {}, 0));
    EXPECT_NEAR(glm::distance(box.lower, Vec3(0, 0, 0)), 0, 1e-5f);
    EXPECT_NEAR(glm::distance(box.upper, Vec3(10, 2, 0)), 0, 1e-5f);
    EXPECT_TRUE(scene_bounds(Scene{}, ScenePose{}).empty());
}

TEST(SceneCameraPose, IgnoresScaleAndMirroring) {
    Scene scene;
    scene.nodes.resize(1);
    scene.nodes[0].local = {{1, 2, 3}, glm::angleAxis(1.5707963f, Vec3(0, 1, 0)), {-2, 3, 0.5f}};
    scene.cameras.push_back({"c", 0, Projection::perspective, 0.6f});
    Camera const camera = scene_camera(scene, evaluate_pose(scene, {}, 0), 0);
    EXPECT_TRUE(is_valid(camera));
    EXPECT_EQ(camera.position, Vec3(1, 2, 3));
    EXPECT_NEAR(glm::distance(camera.forward(), Vec3(-1, 0, 0)), 0, 1e-5f);
    EXPECT_NEAR(glm::distance(camera.up(), Vec3(0, 1, 0)), 0, 1e-5f);
    EXPECT_FLOAT_EQ(camera.vertical_extent, 0.6f);
}

} // namespace
} // namespace framelet
