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

/// Many vertices of four joints, with targets.
TEST(Deform, PositionsAloneAreTheSame) {
    Scene scene;
    scene.nodes.resize(4);
    Skin skin;
    for (Index j = 0; j < 4; ++j) {
        auto const x = static_cast<float>(j);
        scene.nodes[static_cast<std::size_t>(j)].local = {
            {x, 1, -x}, glm::angleAxis(0.4f * x, Vec3(0, 0, 1)), {1, 1 + 0.2f * x, 1}};
        skin.joints.push_back(j);
        skin.inverse_bind_matrices.emplace_back(1);
    }
    Primitive primitive;
    primitive.morph_targets.resize(2);
    for (int i = 0; i < 5000; ++i) {
        auto const x = static_cast<float>(i) * 0.001f;
        auto const part = static_cast<float>(i % 4) * 0.25f;
        primitive.positions.emplace_back(x, 1 - x, std::sin(x));
        primitive.normals.emplace_back(0, 1, 0);
        primitive.influences.push_back({{0, 1, 2, 3}, {1 - part, part * 0.5f, part * 0.3f, part * 0.2f}});
        primitive.morph_targets[1].positions.emplace_back(0, x, 0);
    }
    std::vector<float> const weights{0.7f, -0.3f};
    ScenePose const pose = evaluate_pose(scene, {}, 0);
    for (Skin const* const of : {static_cast<Skin const*>(nullptr), static_cast<Skin const*>(&skin)}) {
        DeformedVertices whole;
        deform(primitive, weights, of, pose, whole);
        std::vector<Vec3> positions(primitive.positions.size());
        Mat3 const linear(0, 2, 0, 1, 0, 0, 0, 0, 3);
        deform_positions(primitive, weights, of, pose, linear, {5, 6, 7}, positions);
        for (std::size_t i = 0; i < positions.size(); ++i) {
            Vec3 const wanted = linear * whole.positions[i] + Vec3(5, 6, 7);
            ASSERT_LT(glm::distance(positions[i], wanted), 1e-4f) << i;
        }
    }
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
