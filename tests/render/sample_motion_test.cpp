#include "server/render/trace/sample_motion.h"

#include <gtest/gtest.h>

#include "scene_builder.h"

namespace framelet {
namespace {

using namespace test;

std::vector<Index> const clips{0};
ImagePlane const plane({32, 32});
Camera const camera = look_at({0, 0, 10}, {0, 0, 0}, {0, 1, 0}, 0.5f);
Tile const centre = make_tile(plane.pixel_depth(), 0, 0);

void animate(Scene& scene, Index node, AnimatedProperty property, std::vector<float> values) {
    scene.clips.resize(1);
    scene.clips[0].duration = 2;
    int const components = static_cast<int>(values.size()) / 2;
    scene.clips[0].channels.push_back({node, property, Interpolation::linear, components, {0, 2}, std::move(values)});
}

/// Renders the quarter of the picture above and left of the middle, at a time of the scene's clips.
Framelet render(Scene const& scene, SceneTime time) {
    RenderScene ready(scene, black());
    ready.set_clips(clips);
    ready.set_pose(evaluate_pose(scene, clips, time));
    Framelet framelet;
    render_framelet(ready, make_view_rays(camera, plane.viewport()), plane, centre, framelet);
    return framelet;
}

Primitive wall(float left, float width, Index material = 0) {
    return quad({left, -10, 0}, {width, 0, 0}, {0, 20, 0}, material);
}

TEST(SampleMotion, SamplesTellTheirBody) {
    Scene scene;
    scene.materials = {matte(Vec3(0.5f))};
    add(scene, wall(-20, 18.6f)); // left of x = -1.4
    Index const node = add(scene, wall(-1.4f, 20));
    animate(scene, node, AnimatedProperty::translation, {0, 0, 0, 0, 4, 0});
    Framelet const framelet = render(scene, 0.25);
    ASSERT_EQ(framelet.body.size(), std::size_t{framelet_samples});
    EXPECT_TRUE(framelet.velocity.empty());
    EXPECT_TRUE(framelet.reflects.none());
    int moving = 0;
    float const pixel = 2 * std::tan(0.25f) / 32 * 10;
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        bool const right = (static_cast<float>(morton_x(i)) + 0.5f - 16) * pixel > -1.4f;
        EXPECT_EQ(framelet.body[i], right ? 1 : 0) << i;
        moving += right ? 1 : 0;
    }
    EXPECT_GT(moving, 16);
    EXPECT_LT(moving, framelet_samples);
}

TEST(SampleMotion, NothingIsKeptWhereNothingMoves) {
    Scene scene;
    scene.materials = {matte(Vec3(0.5f))};
    add(scene, wall(-20, 40));
    Index const elsewhere = add(scene, quad({50, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0));
    animate(scene, elsewhere, AnimatedProperty::translation, {0, 0, 0, 0, 4, 0});
    Framelet const framelet = render(scene, 0.25);
    EXPECT_TRUE(framelet.body.empty());
    EXPECT_TRUE(framelet.velocity.empty());
}

TEST(SampleMotion, WhatShearsHasTheVelocityOfItsTransform) {
    Scene scene;
    scene.materials = {matte(Vec3(0.5f))};
    Index const node = add(scene, wall(-20, 40));
    Node stretching;
    scene.nodes.insert(scene.nodes.begin(), stretching);
    scene.nodes[1].parent = 0;
    // The node is stretched by one axis above something that is turned about the view axis: height grows by 0.5 a
    // second.
    animate(scene, 0, AnimatedProperty::scale, {1, 1, 1, 1, 2, 1});
    animate(scene, node + 1, AnimatedProperty::rotation, {0, 0, 0, 1, 0, 0, 0.01f, 0.99995f});
    Framelet const framelet = render(scene, 0.0);
    EXPECT_TRUE(framelet.body.empty());
    ASSERT_EQ(framelet.velocity.size(), std::size_t{framelet_samples});
    float const pixel = 2 * std::tan(0.25f) / 32 * 10;
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        float const x = (static_cast<float>(morton_x(i)) + 0.5f - 16) * pixel;
        float const y = (16 - 0.5f - static_cast<float>(morton_y(i))) * pixel;
        EXPECT_NEAR(framelet.velocity[i].x, -0.01f * y, 1e-3f);
        EXPECT_NEAR(framelet.velocity[i].y, 0.5f * y + 0.01f * x, 1e-3f);
        EXPECT_NEAR(framelet.velocity[i].z, 0, 1e-4f);
    }
}

Scene morphing_scene() {
    Scene scene;
    scene.materials = {matte(Vec3(0.5f))};
    Primitive primitive = wall(-20, 40);
    primitive.morph_targets.resize(1);
    primitive.morph_targets[0].positions.assign(4, Vec3(0, 0, -3));
    Index const node = add(scene, std::move(primitive));
    animate(scene, node, AnimatedProperty::morph_weights, {0, 1});
    animate(scene, node, AnimatedProperty::translation, {0, 0, 0, 1, 0, 0});
    return scene;
}

TEST(SampleMotion, WhatMorphsHasTheVelocityOfItsVertices) {
    Scene const scene = morphing_scene();
    for (double const time : {0.0, 1.0, 1.999, 2.5}) { // also where the clip is about to start over
        Framelet const framelet = render(scene, time);
        ASSERT_EQ(framelet.velocity.size(), std::size_t{framelet_samples});
        for (Vec3 const& velocity : framelet.velocity) {
            EXPECT_NEAR(velocity.x, 0.5f, 1e-3f);
            EXPECT_NEAR(velocity.z, -1.5f, 1e-3f);
        }
    }
}

TEST(SampleMotion, SkinnedVerticesMoveWithTheirJoints) {
    Scene scene;
    scene.materials = {matte(Vec3(0.5f))};
    Primitive primitive = wall(-20, 40);
    primitive.influences.assign(4, {{0, 0, 0, 0}, {1, 0, 0, 0}});
    Index const node = add(scene, std::move(primitive));
    scene.nodes.emplace_back(); // the joint
    scene.skins.push_back({{1}, {Mat4(1)}});
    scene.nodes[static_cast<std::size_t>(node)].skin = 0;
    animate(scene, 1, AnimatedProperty::translation, {0, 0, 0, 4, 0, -2});
    Framelet const framelet = render(scene, 0.5);
    ASSERT_EQ(framelet.velocity.size(), std::size_t{framelet_samples});
    EXPECT_NEAR(framelet.velocity[9].x, 2, 1e-3f);
    EXPECT_NEAR(framelet.velocity[9].z, -1, 1e-3f);
}

TEST(SampleMotion, VelocityIsAFunctionOfTimeAlone) {
    Scene scene = morphing_scene();
    scene.clips[0].channels[0].times = {1, 2}; // at rest for a second, then it moves
    RenderScene ready(scene, black());
    ready.set_clips(clips);
    Framelet framelet, again;
    auto const render_at = [&](double time, Framelet& out) {
        ready.set_pose(evaluate_pose(scene, clips, time));
        render_framelet(ready, make_view_rays(camera, plane.viewport()), plane, centre, out);
    };
    render_at(1.5, framelet);
    render_at(0.2, again);
    EXPECT_NEAR(again.velocity[0].z, 0, 1e-4f);
    EXPECT_NEAR(again.velocity[0].x, 0.5f, 1e-3f);
    render_at(1.5, again);
    EXPECT_EQ(framelet.velocity, again.velocity);
    EXPECT_NEAR(again.velocity[0].z, -3, 1e-3f);
}

TEST(SampleMotion, MirrorsAreMarkedAndSeeThroughSamplesFollowTheHeaviestSurface) {
    Scene scene;
    Material mirror = matte(Vec3(0.9f)), pane = matte(Vec3(0.5f)), rough = matte(Vec3(0.9f));
    mirror.metallic = rough.metallic = 1;
    mirror.roughness = 0.05f;
    rough.roughness = 0.6f;
    pane.alpha_mode = AlphaMode::blend;
    pane.base_color.a = 0.2f;
    scene.materials = {rough, mirror, pane};
    add(scene, wall(-20, 18.6f));
    Index const node = add(scene, wall(-1.4f, 20, 1));
    add(scene, quad({-10, -10, 2}, {20, 0, 0}, {0, 20, 0}, 2));
    animate(scene, node, AnimatedProperty::translation, {0, 0, 0, 0, 4, 0});
    Framelet const framelet = render(scene, 0.25);
    ASSERT_FALSE(framelet.body.empty());
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        EXPECT_EQ(framelet.reflects[i], framelet.body[i] == 1) << i;
        EXPECT_NEAR(framelet.depth[i], 10, 1e-3f);
    }
    EXPECT_TRUE(framelet.reflects.any());
    EXPECT_FALSE(framelet.reflects.all());
}

} // namespace
} // namespace framelet
