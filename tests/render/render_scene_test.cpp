// Tests poses: what moves, what deforms, what vanishes.
#include "server/render/prepared/render_scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "scene_builder.h"

namespace framelet {
namespace {

using namespace test;

Scene one_sheet(Transform transform = {}) {
    Scene scene;
    Material m = matte({1, 0, 0});
    m.unlit = true;
    m.double_sided = true;
    scene.materials = {m};
    add(scene, quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 0), transform);
    return scene;
}

float depth_at(RenderScene const& scene, Vec3 origin) {
    return look_along(scene, origin, {0, 0, -1}).depth;
}

TEST(RenderScene, PoseMovesAnInstance) {
    Scene const scene = one_sheet();
    RenderScene ready(scene, black());
    EXPECT_NEAR(depth_at(ready, {0, 0, 5}), 5, 1e-5f);
    ScenePose pose = evaluate_pose(scene, {}, 0);
    pose.world_from_node[0][3] = Vec4(10, 0, 1, 1);
    ready.set_pose(pose);
    EXPECT_TRUE(std::isinf(depth_at(ready, {0, 0, 5})));
    EXPECT_NEAR(depth_at(ready, {10, 0, 5}), 4, 1e-5f);
    ready.set_pose(evaluate_pose(scene, {}, 0));
    EXPECT_NEAR(depth_at(ready, {0, 0, 5}), 5, 1e-5f);
}

TEST(RenderScene, ACompactBvhShowsTheSame) {
    Scene scene = one_sheet();
    for (int i = 0; i < 200; ++i) {
        auto const x = 0.37f * static_cast<float>(i % 20), y = 0.31f * static_cast<float>(i / 20);
        add(scene, quad({x - 3, y - 2, 0.01f * static_cast<float>(i)}, {0.3f, 0.1f, 0.2f}, {0, 0.4f, -0.1f}, 0), {});
    }
    RenderScene const fast(scene, black());
    Scene compact_scene = scene;
    compact_scene.bvh = BvhKind::compact;
    for (Mesh& mesh : compact_scene.meshes) { // as after import: the BVH reads them where they are
        for (Primitive& primitive : mesh.primitives) {
            primitive.positions.reserve(primitive.positions.size() + 1);
        }
    }
    RenderScene const compact(compact_scene, black());
    int hits = 0;
    for (int i = 0; i < 400; ++i) {
        Vec3 const origin(0.33f * static_cast<float>(i % 20) - 3, 0.23f * static_cast<float>(i / 20) - 2, 5);
        float const depth = depth_at(fast, origin);
        if (std::isfinite(depth)) {
            EXPECT_NEAR(depth_at(compact, origin), depth, 1e-5f);
            ++hits;
        } else {
            EXPECT_TRUE(std::isinf(depth_at(compact, origin)));
        }
    }
    EXPECT_GT(hits, 100);
}

TEST(RenderScene, OneOfManyMovesAndTheOthersStay) {
    Scene scene = one_sheet();
    for (int i = 1; i < 600; ++i) {
        Node node = scene.nodes[0];
        node.local.translation = {3.0f * static_cast<float>(i), 0, 0};
        scene.nodes.push_back(node);
    }
    RenderScene ready(scene, black());
    ScenePose pose = evaluate_pose(scene, {}, 0);
    for (float z : {1.0f, 2.0f, -1.0f}) {
        pose.world_from_node[7][3].z = z;
        ready.set_pose(pose);
        EXPECT_NEAR(depth_at(ready, {21, 0, 5}), 5 - z, 1e-5f);
        EXPECT_NEAR(depth_at(ready, {18, 0, 5}), 5, 1e-5f);
        EXPECT_NEAR(depth_at(ready, {1797, 0, 5}), 5, 1e-5f);
    }
}

TEST(RenderScene, FlattenedInstancesShow) {
    for (float const across : {1.0f, -1.0f}) {
        // A roof whose ridge is 3 high, flattened along its height, by its node alone or in a turned one below it.
        Scene scene = one_sheet();
        Primitive& roof = scene.meshes[0].primitives[0];
        roof = quad({-1, -1, 0}, {2, 0, 3}, {0, 2, 0}, 0);
        RenderScene ready(scene, black());
        ScenePose pose = evaluate_pose(scene, {}, 0);
        Mat4 flat(1);
        flat[0][0] = across;
        flat[2][2] = 0;
        Mat4 turned(Vec4(0, 1, 0, 0), Vec4(-1, 0, 0, 0), Vec4(0, 0, 1, 0), Vec4(0, 0, 0, 1));
        for (Mat4 const& world : {flat, flat * turned, turned * flat}) {
            pose.world_from_node[0] = world;
            ready.set_pose(pose);
            EXPECT_NEAR(depth_at(ready, {0.5f, 0.25f, 5}), 5, 1e-3f);
            EXPECT_NEAR(depth_at(ready, {-0.9f, -0.9f, 5}), 5, 1e-3f);
            EXPECT_TRUE(std::isinf(depth_at(ready, {1.01f, 0, 5})));
            EXPECT_TRUE(std::isinf(depth_at(ready, {0, -1.01f, 5})));
        }
    }
}

TEST(RenderScene, WhatIsALineVanishesAndComesBack) {
    Transform flat;
    flat.scale = {0, 1, 0};
    Scene const scene = one_sheet(flat);
    RenderScene ready(scene, black());
    EXPECT_TRUE(std::isinf(depth_at(ready, {0, 0, 5})));
    ScenePose pose = evaluate_pose(scene, {}, 0);
    pose.world_from_node[0] = Mat4(1);
    ready.set_pose(pose);
    EXPECT_NEAR(depth_at(ready, {0, 0, 5}), 5, 1e-5f);
    pose.world_from_node[0] = Mat4(0);
    ready.set_pose(pose);
    EXPECT_TRUE(std::isinf(depth_at(ready, {0, 0, 5})));
}

TEST(RenderScene, MorphingMeshIsRefitted) {
    Scene scene = one_sheet();
    MorphTarget up;
    up.positions.assign(4, Vec3(20, 0, 2));
    scene.meshes[0].primitives[0].morph_targets = {up};
    scene.meshes[0].morph_weights = {0};
    RenderScene ready(scene, black());
    EXPECT_NEAR(depth_at(ready, {0, 0, 5}), 5, 1e-5f);
    ScenePose pose = evaluate_pose(scene, {}, 0);
    for (float weight : {0.5f, 1.0f}) {
        pose.morph_weights[0] = {weight};
        ready.set_pose(pose);
        EXPECT_TRUE(std::isinf(depth_at(ready, {0, 0, 5})));
        EXPECT_NEAR(depth_at(ready, {20 * weight, 0, 5}), 5 - 2 * weight, 1e-5f);
    }
}

TEST(RenderScene, SkinnedMeshFollowsItsJointsNotItsNode) {
    Scene scene = one_sheet();
    Node joint;
    scene.nodes.push_back(joint);
    Skin skin;
    skin.joints = {1};
    skin.inverse_bind_matrices = {Mat4(1)};
    scene.skins = {skin};
    scene.nodes[0].skin = 0;
    JointInfluence influence;
    influence.weights = {1, 0, 0, 0};
    scene.meshes[0].primitives[0].influences.assign(4, influence);
    RenderScene ready(scene, black());
    ScenePose pose = evaluate_pose(scene, {}, 0);
    pose.world_from_node[0][3] = Vec4(50, 0, 0, 1); // is to be ignored
    pose.world_from_node[1][3] = Vec4(0, 0, 3, 1);
    ready.set_pose(pose);
    EXPECT_NEAR(depth_at(ready, {0, 0, 5}), 2, 1e-5f);
}

TEST(RenderScene, LightsFollowTheirNodes) {
    Scene scene;
    scene.materials = {matte(Vec3(0.5f))};
    add(scene, quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 0));
    Light lamp;
    lamp.intensity = 10;
    add_light(scene, lamp, {0, 0, 1}, {0, 0, -1});
    RenderScene ready(scene, black());
    float const near = look_along(ready, {0, 0.01f, 0.5f}, {0, 0, -1}).radiance.g;
    ScenePose pose = evaluate_pose(scene, {}, 0);
    pose.world_from_node[1][3] = Vec4(0, 0, 2, 1);
    ready.set_pose(pose);
    EXPECT_NEAR(look_along(ready, {0, 0.01f, 0.5f}, {0, 0, -1}).radiance.g, near / 4, 0.01f * near);
}

TEST(RenderScene, SurroundingsFollowWhatTheSceneBrings) {
    Scene scene;
    RenderScene const bare(scene, std::nullopt);
    EXPECT_EQ(bare.prepared().lights.size(), 1u); // the sun
    RenderScene const mapped(scene, Environment::uniform(Vec3(1)));
    EXPECT_TRUE(mapped.prepared().lights.empty());
    Light lamp;
    add_light(scene, lamp, {0, 0, 0}, {0, 0, -1});
    RenderScene const lit(scene, std::nullopt);
    EXPECT_EQ(lit.prepared().lights.size(), 1u);
    float const dim = look_along(lit, Vec3(0), {0, 1, 0}).radiance.g;
    EXPECT_GT(dim, 0);
    EXPECT_LT(dim, 0.2f);
}

/// Thrown by whoever does not want the scene any more.
struct Unwanted {};

Scene large_and_small() {
    Scene scene = one_sheet();
    for (int i = 0; i < 50; ++i) {
        scene.nodes.push_back(scene.nodes[0]); // the same mesh, which is built once
    }
    constexpr int rings = 300;
    add(scene, sphere({0, 0, -9}, 1, 0, rings));
    return scene;
}

TEST(RenderScene, ProgressOfBvhsIsCountedByTriangles) {
    Scene const scene = large_and_small();
    std::vector<double> told;
    RenderScene const ready(scene, black(), [&](std::string_view what, double fraction) {
        if (what == "building the BVH") {
            told.push_back(fraction);
        }
    });
    ASSERT_GE(told.size(), 3u);
    EXPECT_EQ(told.front(), 0);
    EXPECT_EQ(told.back(), 1);
    EXPECT_GE(std::ranges::count_if(told, [](double f) { return f > 0.1 && f < 0.9; }), 3)
        << "the one large mesh is told of while it is built";
}

TEST(RenderScene, WhoeverIsToldCanEndTheBuilding) {
    Scene const scene = large_and_small();
    for (std::pair<char const*, double> const& last :
         {std::pair("preparing textures", 0.0), std::pair("building the BVH", 0.0), std::pair("building the BVH", 0.3),
          std::pair("building the BVH", 1.0), std::pair("preparing light", 1.0)}) {
        auto const build = [&] {
            RenderScene const ready(scene, black(), [&](std::string_view what, double fraction) {
                if (what == last.first && fraction >= last.second) {
                    throw Unwanted();
                }
            });
        };
        EXPECT_THROW(build(), Unwanted) << last.first << ", " << last.second;
    }
    RenderScene const ready(scene, black());
    EXPECT_NEAR(depth_at(ready, {0, 0, 5}), 5, 1e-5f) << "nothing of those is left in the way";
}

} // namespace
} // namespace framelet
