#include "server/scene/motion/switches.h"

#include <gtest/gtest.h>

#include "server/scene/motion/animation.h"
#include "server/scene/scene_import.h"

namespace framelet {
namespace {

AnimationChannel channel(Interpolation interpolation, std::vector<float> times, std::vector<float> const& x) {
    AnimationChannel out;
    out.node = 0;
    out.interpolation = interpolation;
    out.times = std::move(times);
    for (float const value : x) {
        out.values.insert(out.values.end(), {value, 0, 0});
    }
    return out;
}

Scene scene_of(std::vector<AnimationClip> clips) {
    Scene scene;
    scene.nodes.resize(1);
    scene.clips = std::move(clips);
    return scene;
}

TEST(Switches, AreWhereStepsTakeOtherValuesAndWhereLoopsDoNotClose) {
    Scene const scene = scene_of({
        {"steps", 4, {channel(Interpolation::step, {0, 1, 2, 3}, {5, 5, 7, 5})}},
        {"closed", 2, {channel(Interpolation::linear, {0, 1, 2}, {0, 1, 0})}},
        {"open", 2, {channel(Interpolation::linear, {0, 2}, {0, 1})}},
        {"none", 0, {channel(Interpolation::step, {0}, {0})}},
    });
    std::vector<Index> const clips{0, 1, 2, 3};
    auto const found = find_switches(scene, clips);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].duration, 4);
    EXPECT_EQ(found[0].switches, (std::vector<SceneSwitch>{{2, false}, {3, false}})); // the end is as the beginning
    EXPECT_EQ(found[1].switches, (std::vector<SceneSwitch>{{0, false}}));
}

TEST(Switches, AQuaternionAndItsNegativeAreOne) {
    AnimationChannel turn;
    turn.node = 0;
    turn.property = AnimatedProperty::rotation;
    turn.components = 4;
    turn.times = {0, 1, 2};
    turn.values = {0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, -1};
    Scene const scene = scene_of({{"turn", 2, {turn}}});
    EXPECT_TRUE(find_switches(scene, std::vector<Index>{0}).empty());
}

TEST(Switches, OfCamerasAloneAreNotSeen) {
    Scene scene = scene_of({{"steps", 2, {channel(Interpolation::step, {0, 1}, {0, 1})}}});
    scene.nodes.resize(3);
    auto const seen = [&] { return find_switches(scene, std::vector<Index>{0}).at(0).switches.at(1).is_seen; };
    EXPECT_FALSE(seen());
    scene.nodes[2].mesh = 0;
    EXPECT_FALSE(seen()) << "what is drawn does not go with it";
    scene.nodes[2].parent = 1;
    scene.nodes[1].parent = 0;
    EXPECT_TRUE(seen());
    scene.nodes[2].mesh = none;
    scene.lights.emplace_back();
    scene.lights[0].node = 1;
    EXPECT_TRUE(seen());
    scene.lights.clear();
    scene.skins.push_back({{2}, {}});
    EXPECT_TRUE(seen());
}

/// Keys of a frame each, as exporters bake them: three stays, the middle one too short.
TEST(Switches, OfLightsAreShortWaysBetweenLongStays) {
    std::vector<float> times, x;
    for (int frame = 0; frame < 60; ++frame) { // 2 s
        times.push_back(static_cast<float>(frame) / 30);
        x.push_back(frame < 10 ? 0 : frame < 30 ? 1 : frame < 33 ? 2 : 3);
    }
    Scene scene = scene_of({{"baked", 2, {channel(Interpolation::linear, times, x)}}});
    std::vector<Index> const clips{0};
    auto const inner = [&] {
        auto switches = find_switches(scene, clips).at(0).switches;
        switches.erase(switches.begin()); // the loop does not close
        return switches;
    };
    EXPECT_TRUE(inner().empty()) << "a thing that jerks is not all of the picture";
    scene.lights.emplace_back();
    scene.lights[0].node = 0;
    auto const found = inner();
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NEAR(found[0].time, 9.5 / 30, 1e-6);
    EXPECT_NEAR(found[0].settling, 0.5 / 30, 1e-6);
    EXPECT_TRUE(found[0].is_seen);
    scene.clips[0].channels[0].times = {0, 1, 1.5f, 2}; // a slow way
    scene.clips[0].channels[0].values = {0, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0};
    EXPECT_TRUE(inner().empty());
}

TEST(Switches, OnlyALoneOneIsFoundWhateverTurnOfTheLoopItIsIn) {
    std::vector<ClipSwitches> const clips{{4, {{0, true}, {1.5, false}}}, {3, {{1.5004, true}}}};
    EXPECT_EQ(switches_within(clips, 1.4, 1.6).lone, (SceneSwitch{1.5, true})); // both clips at once
    EXPECT_EQ(switches_within(clips, 1.5, 1.6).lone, (SceneSwitch{1.5004, true}));
    EXPECT_EQ(switches_within(clips, 5.4, 5.6).lone, (SceneSwitch{5.5, false}));
    EXPECT_EQ(switches_within(clips, 1.0, 1.2).lone, std::nullopt);
    EXPECT_EQ(switches_within(clips, 3.9, 4.1).lone, (SceneSwitch{4, true}));
    EXPECT_EQ(switches_within(clips, 399.95, 400.05).lone, (SceneSwitch{400, true}));
    EXPECT_EQ(switches_within(clips, 3.9, 4.6).lone, std::nullopt); // 4 and 4.5004
    EXPECT_EQ(switches_within(clips, 0, 5).lone, std::nullopt);
    EXPECT_EQ(switches_within({}, 0, 5).lone, std::nullopt);
    EXPECT_TRUE(switches_within(clips, 1.4, 1.6).any);
    EXPECT_TRUE(switches_within(clips, 3.9, 4.6).any);
    EXPECT_TRUE(switches_within(clips, 0, 5).any);
    EXPECT_FALSE(switches_within(clips, 1.0, 1.2).any);
    EXPECT_FALSE(switches_within({}, 0, 5).any);
}

/// Compares the switches found with the values that the scene takes.
TEST(Switches, OfABundledSceneAreWhereItsPoseJumps) {
    Scene const scene = import_scene(FRAMELET_SOURCE_DIR "/scenes/flicker.glb");
    std::vector<Index> const clips = default_clips(scene);
    auto const found = find_switches(scene, clips);
    ASSERT_EQ(found.size(), 1u);
    ASSERT_FALSE(found[0].switches.empty());
    for (double time = 0.005; time < found[0].duration; time += 0.01) {
        bool const jumps = evaluate_pose(scene, clips, time).world_from_node !=
                           evaluate_pose(scene, clips, time + 0.01).world_from_node;
        EXPECT_EQ(switches_within(found, time, time + 0.01).lone.has_value(), jumps) << time;
    }
}

} // namespace
} // namespace framelet
