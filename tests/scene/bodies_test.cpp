#include "server/scene/motion/bodies.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

Index add_node(Scene& scene, Index parent, bool drawn = true) {
    Node node;
    node.parent = parent;
    if (drawn) {
        node.mesh = 0;
    }
    scene.nodes.push_back(node);
    return static_cast<Index>(scene.nodes.size()) - 1;
}

void animate(Scene& scene, Index node, AnimatedProperty property, std::vector<float> values) {
    int const components = static_cast<int>(values.size()) / 2;
    scene.clips[0].channels.push_back({node, property, Interpolation::linear, components, {0, 2}, std::move(values)});
}

Scene empty_scene() {
    Scene scene;
    scene.meshes.resize(1);
    scene.clips.resize(1);
    scene.clips[0].duration = 2;
    return scene;
}

float const quarter = std::sqrt(0.5f);
std::vector<float> const quarter_turn{0, 0, 0, 1, 0, quarter, 0, quarter};
std::vector<Index> const clips{0};

TEST(Bodies, NodesOfOneBodyShareANumber) {
    Scene scene = empty_scene();
    Index const ground = add_node(scene, none);
    Index const rig = add_node(scene, none, false);
    Index const hull = add_node(scene, rig);
    Index const mirror = add_node(scene, hull);
    Index const wheel = add_node(scene, rig);
    Index const tyre = add_node(scene, wheel);
    Index const camera = add_node(scene, none, false);
    Index const idle = add_node(scene, none);
    animate(scene, rig, AnimatedProperty::translation, {0, 0, 0, 6, 0, 0});
    animate(scene, wheel, AnimatedProperty::rotation, quarter_turn);
    animate(scene, camera, AnimatedProperty::translation, {0, 0, 0, 6, 0, 0});
    animate(scene, idle, AnimatedProperty::translation, {0, 0, 0, 0, 0, 0});
    SceneBodies const bodies = find_bodies(scene, clips);
    EXPECT_EQ(bodies.frames, (std::vector<Index>{none, rig, wheel}));
    std::vector<BodyNumber> const expected{0, 0, 1, 1, 2, 2, 0, 0};
    EXPECT_EQ(bodies.body_of_node, expected);
    EXPECT_FALSE(bodies.any_flows());
    EXPECT_FALSE(find_bodies(scene, {}).any_moves());
    EXPECT_EQ(bodies.body_of_node[static_cast<std::size_t>(ground)], static_body);
    EXPECT_EQ(bodies.body_of_node[static_cast<std::size_t>(mirror)], 1);
    EXPECT_EQ(bodies.body_of_node[static_cast<std::size_t>(tyre)], 2);
}

TEST(Bodies, PosesCarryPointsAsTheSceneDoes) {
    Scene scene = empty_scene();
    Index const rig = add_node(scene, none, false);
    Index const wheel = add_node(scene, rig);
    Index const tyre = add_node(scene, wheel);
    scene.nodes[static_cast<std::size_t>(rig)].local.scale = Vec3(-2, 2, 2); // mirrored
    scene.nodes[static_cast<std::size_t>(wheel)].local.scale = Vec3(1, 3, 0.5f);
    scene.nodes[static_cast<std::size_t>(tyre)].local = {{1, 2, 3}, glm::angleAxis(0.3f, Vec3(0, 0, 1)), {1, 2, 1}};
    animate(scene, rig, AnimatedProperty::translation, {0, 1, 0, 6, 0, 2});
    animate(scene, wheel, AnimatedProperty::rotation, quarter_turn);
    SceneBodies const bodies = find_bodies(scene, clips);
    ASSERT_EQ(bodies.body_of_node[static_cast<std::size_t>(tyre)], 1);
    auto const placed = [](BodyPose const& pose, Vec3 const& p) {
        return pose.rotation * (pose.scale * p) + pose.translation;
    };
    ScenePose const first = evaluate_pose(scene, clips, 0.3);
    ScenePose const later = evaluate_pose(scene, clips, 1.7);
    BodyPose const from = body_pose(bodies, first, 1), to = body_pose(bodies, later, 1);
    for (Vec3 const& p : {Vec3(0), Vec3(1, 0, 0), Vec3(-2, 5, 1), Vec3(0.5f, -3, 7)}) {
        auto const world = [&](ScenePose const& pose) {
            return Vec3(pose.world_from_node[static_cast<std::size_t>(tyre)] * Vec4(p, 1));
        };
        Vec3 const in_body = (glm::conjugate(from.rotation) * (world(first) - from.translation)) / from.scale;
        EXPECT_LT(glm::distance(placed(to, in_body), world(later)), 1e-4f);
    }
    EXPECT_EQ(body_pose(bodies, later, static_body), BodyPose{});
}

TEST(Bodies, WhatShearsOrDeformsFlows) {
    Scene scene = empty_scene();
    Index const squashed = add_node(scene, none); // never moves: its own scale shears nothing
    Index const turning = add_node(scene, squashed);
    Index const pulsing = add_node(scene, none); // scaled along one axis: still translation, rotation, scale
    Index const below = add_node(scene, pulsing); // static below it: carried along
    Index const turned_below = add_node(scene, pulsing);
    Index const morphing = add_node(scene, none);
    Index const skinned = add_node(scene, none), stiff = add_node(scene, none);
    scene.nodes[static_cast<std::size_t>(squashed)].local.scale = Vec3(1, 2, 1);
    animate(scene, turning, AnimatedProperty::rotation, quarter_turn);
    animate(scene, pulsing, AnimatedProperty::scale, {1, 1, 1, 1, 3, 1});
    animate(scene, turned_below, AnimatedProperty::rotation, quarter_turn);
    animate(scene, morphing, AnimatedProperty::morph_weights, {0, 1});
    scene.skins = {{{squashed, turning}, {}}, {{squashed}, {}}};
    scene.nodes[static_cast<std::size_t>(skinned)].skin = 0;
    scene.nodes[static_cast<std::size_t>(stiff)].skin = 1;
    SceneBodies const bodies = find_bodies(scene, clips);
    EXPECT_EQ(bodies.frames, (std::vector<Index>{none, turning, pulsing, turned_below, morphing}));
    std::vector<bool> const flows{false, true, false, false, true, true, true, false};
    EXPECT_EQ(bodies.flows, flows);
    EXPECT_EQ(bodies.body_of_node[static_cast<std::size_t>(below)], 2);
    EXPECT_EQ(bodies.body_of_node[static_cast<std::size_t>(turned_below)], 3) << "as far as a body can be";
    EXPECT_EQ(bodies.body_of_node[static_cast<std::size_t>(skinned)], static_body) << "its joints carry it";
}

TEST(Bodies, TooManyFlow) {
    Scene scene = empty_scene();
    for (std::size_t i = 0; i < most_bodies + 2; ++i) {
        animate(scene, add_node(scene, none), AnimatedProperty::translation, {0, 0, 0, 6, 0, 0});
    }
    SceneBodies const bodies = find_bodies(scene, clips);
    EXPECT_EQ(bodies.frames.size(), most_bodies + 1);
    std::vector<BodyNumber> const last_numbers(bodies.body_of_node.end() - 3, bodies.body_of_node.end());
    EXPECT_EQ(last_numbers, (std::vector<BodyNumber>{most_bodies, static_body, static_body}));
    std::vector<bool> const last_flow(bodies.flows.end() - 3, bodies.flows.end());
    EXPECT_EQ(last_flow, (std::vector<bool>{false, true, true}));
}

TEST(Bodies, TracksHoldThePoseOfEveryKey) {
    Scene scene = empty_scene();
    Index const node = add_node(scene, none);
    animate(scene, node, AnimatedProperty::translation, {0, 0, 0, 6, 0, 0}); // 3 m/s, starts over after 2 s
    SceneBodies const bodies = find_bodies(scene, clips);
    PoseEvaluator poses(scene, clips);
    std::vector<BodyTrack> const tracks = body_tracks(poses, bodies, 60, 90);
    ASSERT_EQ(tracks.size(), 1u);
    EXPECT_EQ(tracks[0].body, 1);
    EXPECT_EQ(tracks[0].first_key, 60);
    ASSERT_EQ(tracks[0].keys.size(), 90u);
    EXPECT_NEAR(tracks[0].keys[0].translation.x, 3, 1e-5f);
    EXPECT_NEAR(tracks[0].keys[30].translation.x, 4.5f, 1e-5f);
    EXPECT_NEAR(tracks[0].keys[80].translation.x, 1, 1e-5f);
    EXPECT_EQ(body_tracks(poses, bodies, 70, 1)[0].keys[0], tracks[0].keys[10]) << "whatever the span";
}

TEST(Bodies, WhatShrinksToNothingHasAFinitePose) {
    Scene scene = empty_scene();
    Index const node = add_node(scene, none);
    animate(scene, node, AnimatedProperty::scale, {0, 0, 0, 1, 1, 1});
    SceneBodies const bodies = find_bodies(scene, clips);
    BodyPose const pose = body_pose(bodies, evaluate_pose(scene, clips, 0), 1);
    EXPECT_EQ(pose.scale, Vec3(0));
    EXPECT_NEAR(glm::length(pose.rotation), 1, 1e-5f);
}

} // namespace
} // namespace framelet
