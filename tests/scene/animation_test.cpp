#include "server/scene/motion/animation.h"

#include <gtest/gtest.h>

#include "server/scene/motion/keyframes.h"

namespace framelet {
namespace {

AnimationChannel translation(Index node, Interpolation interpolation, std::vector<float> times,
                             std::vector<float> values) {
    return {node, AnimatedProperty::translation, interpolation, 3, std::move(times), std::move(values)};
}

float first_of(AnimationChannel const& channel, float seconds) {
    std::array<float, 3> out{};
    sample_channel(channel, seconds, out);
    return out[0];
}

TEST(Keyframes, LinearAndClampedAtTheEnds) {
    auto const channel = translation(0, Interpolation::linear, {1, 2, 4}, {10, 0, 0, 20, 0, 0, 0, 0, 0});
    EXPECT_EQ(first_of(channel, 0), 10);
    EXPECT_EQ(first_of(channel, 1.25f), 12.5f);
    EXPECT_EQ(first_of(channel, 2), 20);
    EXPECT_EQ(first_of(channel, 3), 10);
    EXPECT_EQ(first_of(channel, 9), 0);
}

TEST(Keyframes, StepHoldsUntilTheNextKey) {
    auto const channel = translation(0, Interpolation::step, {0, 1}, {10, 0, 0, 20, 0, 0});
    EXPECT_EQ(first_of(channel, 0.999f), 10);
    EXPECT_EQ(first_of(channel, 1), 20);
}

TEST(Keyframes, CubicSplineScalesTangentsByTheInterval) {
    // glTF 2.0 appendix C.5: at the middle of an interval of 2 s, value = (v0 + v1) / 2 + 2 * (b0 - a1) / 8.
    auto const channel = translation(0, Interpolation::cubic_spline, {1, 3},
                                     {9, 0, 0, 10, 0, 0, 4, 0, 0, /* second key */ -8, 0, 0, 20, 0, 0, 9, 0, 0});
    EXPECT_FLOAT_EQ(first_of(channel, 2), 15 + 2 * (4 + 8) / 8.0f);
    EXPECT_EQ(first_of(channel, 0), 10);
    EXPECT_EQ(first_of(channel, 1), 10);
    EXPECT_EQ(first_of(channel, 3), 20);
    // A spline whose tangents are those of t^2 is t^2.
    auto const square =
        translation(0, Interpolation::cubic_spline, {0, 2}, {0, 0, 0, 0, 0, 0, 0, 0, 0, 4, 0, 0, 4, 0, 0, 4, 0, 0});
    EXPECT_FLOAT_EQ(first_of(square, 0.5f), 0.25f);
    EXPECT_FLOAT_EQ(first_of(square, 1.5f), 2.25f);
}

/// Pictures of a scene at rest are told from those of a moving one by the bits of their cameras and bodies.
TEST(Keyframes, RestIsExact) {
    AnimationChannel const channel{0,
                                   AnimatedProperty::rotation,
                                   Interpolation::linear,
                                   4,
                                   {0, 1},
                                   {0.1f, -0.7f, 0.3f, 0.64f, 0.1f, -0.7f, 0.3f, 0.64f}};
    std::array<float, 4> first{}, q{};
    sample_channel(channel, 0, first);
    for (int i = 1; i <= 100; ++i) {
        sample_channel(channel, static_cast<float>(i) / 100, q);
        EXPECT_EQ(q, first);
    }
}

TEST(Keyframes, RotationsTakeTheShorterArcAndStayUnit) {
    float const h = std::sqrt(0.5f);
    // The second key is a quarter turn about y, written with the opposite sign.
    AnimationChannel const channel{0,      AnimatedProperty::rotation, Interpolation::linear, 4,
                                   {0, 1}, {0, 0, 0, 2, 0, -h, 0, -h}};
    std::array<float, 4> q{};
    sample_channel(channel, 0.5f, q);
    EXPECT_NEAR(std::abs(q[1]), std::sin(0.3926991f), 1e-5f);
    EXPECT_NEAR(std::abs(q[3]), std::cos(0.3926991f), 1e-5f);
    EXPECT_GT(q[1] * q[3], 0);
    sample_channel(channel, 0, q);
    EXPECT_EQ(q[3], 1) << "normalised";
}

/// root -> arm, each with a clip that moves it along x.
Scene two_nodes() {
    Scene scene;
    scene.nodes.resize(2);
    scene.nodes[1].parent = 0;
    scene.clips.push_back({"a", 2, {translation(0, Interpolation::linear, {0, 2}, {0, 0, 0, 2, 0, 0})}});
    scene.clips.push_back({"b", 4, {translation(0, Interpolation::linear, {0, 4}, {0, 0, 0, 0, 9, 0})}});
    scene.clips.push_back({"c", 3, {translation(1, Interpolation::linear, {0, 3}, {0, 0, 0, 0, 0, 3})}});
    return scene;
}

TEST(Animation, FirstClipAndThoseThatMoveOtherNodes) {
    EXPECT_EQ(default_clips(two_nodes()), (std::vector<Index>{0, 2}));
    EXPECT_TRUE(default_clips(Scene{}).empty());
}

TEST(Animation, ClipsLoopEachWithItsOwnDuration) {
    Scene const scene = two_nodes();
    auto const clips = default_clips(scene);
    EXPECT_EQ(animation_duration(scene, clips), 3);
    EXPECT_EQ(animation_duration(scene, {}), 0);
    ScenePose const pose = evaluate_pose(scene, clips, 5.0); // 5 mod 2 = 1, 5 mod 3 = 2
    EXPECT_EQ(Vec3(pose.world_from_node[0][3]), Vec3(1, 0, 0));
    EXPECT_EQ(Vec3(pose.world_from_node[1][3]), Vec3(1, 0, 2));
    EXPECT_EQ(Vec3(evaluate_pose(scene, clips, 6000001).world_from_node[0][3]), Vec3(1, 0, 0)) << "exact after weeks";
}

TEST(Animation, OneMomentAfterAnotherIsPosedAsEachAlone) {
    Scene scene = two_nodes();
    scene.nodes.resize(5);
    scene.nodes[1].local.translation = {0, 5, 0};
    scene.nodes[2].local.translation = {0, 0, 7}; // nothing moves it
    scene.nodes[3].parent = 1; // moves with what is around it
    scene.nodes[3].local.scale = Vec3(2);
    scene.nodes[4].parent = 2;
    scene.meshes.resize(1);
    scene.meshes[0].morph_weights = {0.5f};
    scene.nodes[4].mesh = 0;
    scene.clips[0].channels.push_back({4, AnimatedProperty::morph_weights, Interpolation::linear, 1, {0, 2}, {0, 1}});
    auto const clips = default_clips(scene);
    PoseEvaluator poses(scene, clips);
    for (double const time : {0.5, 2.75, 0.5, 1e6, 0.0, 1.999}) {
        ScenePose const& pose = poses.at(time);
        ScenePose const alone = evaluate_pose(scene, clips, time);
        EXPECT_EQ(pose.time, time);
        EXPECT_EQ(pose.world_from_node, alone.world_from_node) << time;
        EXPECT_EQ(pose.morph_weights, alone.morph_weights) << time;
    }
}

TEST(Animation, MovingNodesIncludeDescendants) {
    Scene scene = two_nodes();
    EXPECT_EQ(moving_nodes(scene, std::vector<Index>{0}), (std::vector<bool>{true, true}));
    EXPECT_EQ(moving_nodes(scene, std::vector<Index>{2}), (std::vector<bool>{false, true}));
    scene.clips.push_back({"still", 1, {translation(0, Interpolation::linear, {0, 1}, {0, 0, 0, 0, 0, 0})}});
    EXPECT_EQ(moving_nodes(scene, std::vector<Index>{3}), (std::vector<bool>{false, false}))
        << "keys as the node itself";
}

TEST(Animation, MorphWeightsAreAnimatedPerNode) {
    Scene scene;
    scene.nodes.resize(2);
    scene.meshes.resize(1);
    scene.meshes[0].morph_weights = {0.5f, 0.25f};
    scene.nodes[0].mesh = scene.nodes[1].mesh = 0;
    scene.clips.push_back(
        {"w", 1, {{1, AnimatedProperty::morph_weights, Interpolation::linear, 2, {0, 1}, {0, 1, 1, 0}}}});
    ScenePose const pose = evaluate_pose(scene, default_clips(scene), 0.25);
    EXPECT_EQ(pose.morph_weights[0], (std::vector<float>{0.5f, 0.25f}));
    EXPECT_EQ(pose.morph_weights[1], (std::vector<float>{0.25f, 0.75f}));
}

TEST(Animation, TransformIsTranslationRotationScale) {
    Scene scene;
    scene.nodes.resize(2);
    scene.nodes[1].parent = 0;
    scene.nodes[0].matrix = Mat4(1);
    (*scene.nodes[0].matrix)[3] = Vec4(0, 0, 5, 1);
    scene.nodes[1].local = {{1, 2, 3}, glm::angleAxis(1.5707963f, Vec3(0, 0, 1)), {2, 1, 1}};
    Vec4 const moved = evaluate_pose(scene, {}, 0).world_from_node[1] * Vec4(1, 0, 0, 1);
    EXPECT_NEAR(glm::distance(moved, Vec4(1, 4, 8, 1)), 0, 1e-5f);
}

TEST(Animation, OverflowingTransformsShrinkToNothing) {
    Scene scene;
    scene.nodes.resize(3);
    for (std::size_t i = 0; i < 3; ++i) {
        scene.nodes[i].parent = static_cast<Index>(i) - 1;
        scene.nodes[i].local.scale = Vec3(1e30f);
    }
    EXPECT_EQ(evaluate_pose(scene, {}, 0).world_from_node[2][0], Vec4(0));
}

} // namespace
} // namespace framelet
