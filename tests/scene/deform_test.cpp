#include <gtest/gtest.h>

#include "server/scene/motion/animation.h"

namespace framelet {
namespace {

Primitive triangle() {
    Primitive primitive;
    primitive.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    primitive.normals.assign(3, Vec3(0, 0, 1));
    primitive.tangents.assign(3, Vec4(1, 0, 0, 1));
    primitive.triangles = {{0, 1, 2}};
    return primitive;
}

TEST(Deform, MorphAddsWeightedOffsets) {
    Primitive primitive = triangle();
    primitive.morph_targets.push_back({{{0, 0, 2}, {0, 0, 0}, {0, 0, 0}}, {{1, 0, -1}, {0, 0, 0}, {0, 0, 0}}, {}});
    primitive.morph_targets.push_back({{{4, 0, 0}, {0, 0, 0}, {0, 0, 0}}, {}, {}});
    DeformedVertices out;
    deform(primitive, std::vector<float>{1, 0.5f}, nullptr, {}, out);
    EXPECT_EQ(out.positions[0], Vec3(2, 0, 2));
    EXPECT_EQ(out.positions[1], Vec3(1, 0, 0));
    EXPECT_EQ(out.normals[0], Vec3(1, 0, 0));
    EXPECT_EQ(out.normals[1], Vec3(0, 0, 1));
    EXPECT_NEAR(glm::dot(Vec3(out.tangents[0]), out.normals[0]), 0, 1e-6f) << "tangents stay in the surface";
}

TEST(Deform, SkinBlendsJointsAndIgnoresTheNode) {
    // Joint 0 stays; joint 1, bound at (0, 1, 0), turns by a quarter about z there.
    Scene scene;
    scene.nodes.resize(3);
    scene.nodes[0].local.translation = {100, 0, 0}; // the mesh's own node
    scene.nodes[2].local = {{0, 1, 0}, glm::angleAxis(1.5707963f, Vec3(0, 0, 1)), {1, 1, 1}};
    Skin skin;
    skin.joints = {1, 2};
    skin.inverse_bind_matrices = {Mat4(1), Mat4(1)};
    skin.inverse_bind_matrices[1][3] = Vec4(0, -1, 0, 1);
    Primitive primitive = triangle();
    primitive.positions = {{0, 2, 0}, {0, 2, 0}, {0, 2, 0}};
    primitive.normals.assign(3, Vec3(0, 1, 0));
    primitive.influences = {
        {{0, 0, 0, 0}, {1, 0, 0, 0}}, {{1, 0, 0, 0}, {1, 0, 0, 0}}, {{0, 1, 0, 0}, {0.5f, 0.5f, 0, 0}}};
    DeformedVertices out;
    deform(primitive, {}, &skin, evaluate_pose(scene, {}, 0), out);
    EXPECT_NEAR(glm::distance(out.positions[0], Vec3(0, 2, 0)), 0, 1e-5f);
    EXPECT_NEAR(glm::distance(out.positions[1], Vec3(-1, 1, 0)), 0, 1e-5f);
    EXPECT_NEAR(glm::distance(out.positions[2], Vec3(-0.5f, 1.5f, 0)), 0, 1e-5f);
    EXPECT_NEAR(glm::distance(out.normals[1], Vec3(-1, 0, 0)), 0, 1e-5f);
    EXPECT_NEAR(glm::length(out.normals[2]), 1, 1e-5f);
}

TEST(Deform, NormalsOfStretchedAndMirroredJoints) {
    Scene scene;
    scene.nodes.resize(1);
    Skin skin{{0}, {Mat4(1)}};
    Primitive primitive = triangle();
    float const h = std::sqrt(0.5f);
    primitive.normals.assign(3, Vec3(h, 0, h));
    primitive.tangents.assign(3, Vec4(0, 1, 0, 1));
    primitive.influences.assign(3, {{}, {1, 0, 0, 0}});
    DeformedVertices out;
    scene.nodes[0].local.scale = {2, 1, 1};
    deform(primitive, {}, &skin, evaluate_pose(scene, {}, 0), out);
    EXPECT_NEAR(glm::distance(out.normals[0], glm::normalize(Vec3(0.5f, 0, 1))), 0, 1e-5f) << "inverse transpose";
    EXPECT_EQ(out.tangents[0].w, 1);
    scene.nodes[0].local.scale = {-1, 1, 1};
    deform(primitive, {}, &skin, evaluate_pose(scene, {}, 0), out);
    EXPECT_NEAR(glm::distance(out.normals[0], Vec3(-h, 0, h)), 0, 1e-5f) << "a mirror does not turn normals inside";
    EXPECT_EQ(out.tangents[0].w, -1);
}

TEST(Deform, CollapsedJointsLeaveFiniteUnitNormals) {
    Scene scene;
    scene.nodes.resize(1);
    scene.nodes[0].local.scale = {0, 0, 0};
    Skin skin{{0}, {Mat4(1)}};
    Primitive primitive = triangle();
    primitive.influences.assign(3, {{}, {1, 0, 0, 0}});
    DeformedVertices out;
    deform(primitive, {}, &skin, evaluate_pose(scene, {}, 0), out);
    EXPECT_EQ(out.positions[1], Vec3(0));
    EXPECT_NEAR(glm::length(out.normals[1]), 1, 1e-5f);
    EXPECT_NEAR(glm::length(Vec3(out.tangents[1])), 1, 1e-5f);
}

TEST(Deform, ReusedMemoryDoesNotMove) {
    Primitive primitive = triangle();
    primitive.morph_targets.push_back({{{0, 0, 2}, {0, 0, 0}, {0, 0, 0}}, {}, {}});
    DeformedVertices out;
    deform(primitive, std::vector<float>{1}, nullptr, {}, out);
    Vec3 const* const before = out.positions.data();
    deform(primitive, std::vector<float>{0}, nullptr, {}, out);
    EXPECT_EQ(out.positions.data(), before);
    EXPECT_EQ(out.positions, primitive.positions);
}

} // namespace
} // namespace framelet
