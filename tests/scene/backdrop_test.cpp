#include "server/scene/backdrop.h"

#include <gtest/gtest.h>

#include "server/scene/scene_import.h"

namespace framelet {
namespace {

Bounds box(Vec3 lower, Vec3 upper) {
    return {lower, upper};
}

/// A box upon the ground, about the middle.
Bounds standing(float width, float height) {
    return box({-0.5f * width, 0, -0.5f * width}, {0.5f * width, height, 0.5f * width});
}

ScenePart sky(float radius) {
    return {box({-radius, -0.03f * radius, -radius}, {radius, 0.8f * radius, radius}), false};
}

void expect_box(Bounds const& found, Bounds const& expected) {
    EXPECT_EQ(found.lower, expected.lower);
    EXPECT_EQ(found.upper, expected.upper);
}

ScenePart const table{standing(2, 1)};
ScenePart const chair{box({2, 0, 0}, {3, 1, 1})};
Bounds const furniture = box({-1, 0, -1}, {3, 1, 1});

TEST(Backdrop, ASkyOfTrianglesIsOne) {
    expect_box(without_backdrop({table, sky(1500), chair}), furniture);
    expect_box(without_backdrop({table, sky(10), chair}), furniture);
    expect_box(without_backdrop({table, {sky(1500).box, true}, chair}), furniture); // many times larger
}

TEST(Backdrop, WhatStandsAboutTheRestFarOutGoesWithTheSky) {
    ScenePart const meadow{standing(120, 0)}, fields{standing(1900, 0)}, hills{standing(2600, 80)};
    expect_box(without_backdrop({hills, meadow, table, fields, sky(1500)}), standing(120, 1));
    ScenePart const road{box({-160, 0, -660}, {160, 1, 780})};
    expect_box(without_backdrop({hills, road, table, fields, sky(1500)}), road.box);
}

TEST(Backdrop, WithoutASkyTheGroundCounts) {
    ScenePart const ground{standing(1000, 0)};
    expect_box(without_backdrop({ground, table}), standing(1000, 1));
}

TEST(Backdrop, ARoomCounts) {
    ScenePart const room{standing(30, 6)};
    expect_box(without_backdrop({room, table, chair}), room.box);
    // Where light is in all colours already, none of them is a sky for that.
    expect_box(without_backdrop({{room.box, false}, {table.box, false}, {chair.box, false}}), room.box);
    expect_box(without_backdrop({{standing(5, 3), false}, {standing(4, 2)}}), standing(5, 3)); // of a usual size
}

TEST(Backdrop, WhatDoesNotHoldAllTheRestIsNone) {
    ScenePart const far_tree{box({1600, 0, 0}, {1602, 5, 2})};
    expect_box(without_backdrop({table, sky(1500), far_tree}), box({-1500, -45, -1500}, {1602, 1200, 1500}));
    ScenePart const tower{standing(2, 1300)};
    expect_box(without_backdrop({tower, sky(1500)}), box({-1500, -45, -1500}, {1500, 1300, 1500}));
}

TEST(Backdrop, OnePartAloneCounts) {
    expect_box(without_backdrop({sky(10)}), sky(10).box);
    expect_box(without_backdrop({sky(10), sky(10)}), sky(10).box);
    EXPECT_TRUE(without_backdrop({}).empty());
}

TEST(Backdrop, BundledScenesAreLookedAtWithoutTheirSurroundings) {
    Scene const scene = import_scene(FRAMELET_SOURCE_DIR "/scenes/windmill.glb");
    ScenePose const pose = evaluate_pose(scene, default_clips(scene), 0);
    EXPECT_NEAR(scene_bounds(scene, pose).size().x, 2998, 1);
    EXPECT_NEAR(without_backdrop(scene_parts(scene, pose)).size().x, 120, 1);
}

TEST(ScenePart, UnlitOrBlackMeansThatItTakesNoLight) {
    Scene scene;
    scene.materials.resize(3);
    scene.materials[1].unlit = true;
    scene.materials[2].base_color = {0, 0, 0, 1};
    Primitive primitive;
    primitive.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    primitive.triangles = {{0, 1, 2}};
    scene.meshes.emplace_back();
    for (Index const material : {0, 1, 2}) {
        primitive.material = material;
        scene.meshes[0].primitives.push_back(primitive);
    }
    scene.nodes.emplace_back().mesh = 0;
    std::vector<ScenePart> const parts = scene_parts(scene, evaluate_pose(scene, {}, 0));
    ASSERT_EQ(parts.size(), 3u);
    EXPECT_TRUE(parts[0].takes_light);
    EXPECT_FALSE(parts[1].takes_light);
    EXPECT_FALSE(parts[2].takes_light);
}

} // namespace
} // namespace framelet
