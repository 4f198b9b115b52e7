#include "server/render/trace/shadow_motion.h"

#include <limits>

#include <gtest/gtest.h>

#include "scene_builder.h"

namespace framelet {
namespace {

using namespace test;

std::vector<Index> const clips{0};
ImagePlane const plane({32, 32});
Camera const camera = look_at({0, 0, 10}, {0, 0, 0}, {0, 1, 0}, 0.5f);
Tile const tile = make_tile(plane.pixel_depth(), 0, 0); // the quarter above and left of the middle
constexpr SceneTime moment = 0.25;
constexpr float edge = -1.4f; // x of the shadow's edge, metres

Light lamp(LightType type, float intensity) {
    Light light;
    light.type = type;
    light.color = Vec3(1);
    light.intensity = intensity;
    return light;
}

/// Point of the floor, z = 0, that the sample shows.
Vec3 position_of(std::uint32_t sample) {
    float const pixel = 2 * std::tan(0.25f) / 32 * 10;
    return {(static_cast<float>(morton_x(sample)) + 0.5f - 16) * pixel,
            (16 - 0.5f - static_cast<float>(morton_y(sample))) * pixel, 0};
}

void move(Scene& scene, Index node, Vec3 const& velocity) {
    scene.clips.resize(1);
    scene.clips[0].duration = 2;
    Vec3 const end = 2.0f * velocity;
    scene.clips[0].channels.push_back(
        {node, AnimatedProperty::translation, Interpolation::linear, 3, {0, 2}, {0, 0, 0, end.x, end.y, end.z}});
}

Scene floor_scene() {
    Scene scene;
    scene.materials = {matte(Vec3(0.5f))};
    add(scene, quad({-50, -50, 0}, {100, 0, 0}, {0, 100, 0}, 0));
    return scene;
}

/// A board above the camera, 12 metres above the floor at `moment`, that ends at x = `right` then.
Primitive board(float right, Vec3 const& velocity = Vec3(0)) {
    return quad(Vec3(right - 40, -20, 12) - static_cast<float>(moment) * velocity, {40, 0, 0}, {0, 40, 0}, 0);
}

struct Rendered {
    Framelet framelet;
    std::uint32_t segments = 0;
};

Rendered render(Scene const& scene, bool plays = true) {
    RenderScene ready(scene, black());
    if (plays) {
        ready.set_clips(clips);
    }
    ready.set_pose(evaluate_pose(scene, clips, moment));
    Rendered out;
    out.segments = render_framelet(ready, make_view_rays(camera, plane.viewport()), plane, tile, out.framelet);
    return out;
}

/// A scene under a sun from the left, 1 to 2: what is 12 metres up throws its shadow 6 metres farther right.
Scene sunny_scene(Vec3 const& velocity) {
    Scene scene = floor_scene();
    Index const node = add(scene, board(edge - 6, velocity));
    move(scene, node, velocity);
    add_light(scene, lamp(LightType::directional, 3), Vec3(0), {1, 0, -2});
    return scene;
}

TEST(ShadowMotion, UnderASunAShadowGoesWithWhatThrowsItAlongTheFloor) {
    Rendered const rendered = render(sunny_scene({3, 1, -0.5f}));
    Framelet const& framelet = rendered.framelet;
    ASSERT_EQ(framelet.drift.size(), std::size_t{framelet_samples});
    EXPECT_TRUE(framelet.body.empty());
    std::uint32_t dark = 0;
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        bool const in_shadow = position_of(i).x < edge;
        EXPECT_EQ(framelet.red[i] == 0, in_shadow) << i;
        EXPECT_LT(glm::distance(framelet.drift[i].velocity, in_shadow ? Vec3(2.75f, 1, 0) : Vec3(0)), 1e-2f) << i;
        dark += in_shadow ? 1 : 0;
    }
    EXPECT_GT(dark, 16u);
    EXPECT_LT(dark, std::uint32_t{framelet_samples});
    EXPECT_EQ(rendered.segments, 2 * framelet_samples + dark) << "one ray more where there is shadow";
}

TEST(ShadowMotion, WhereNothingMovesNoRayIsTracedForIt) {
    Rendered const rendered = render(sunny_scene({3, 1, -0.5f}), false);
    EXPECT_TRUE(rendered.framelet.drift.empty());
    EXPECT_EQ(rendered.segments, 2u * framelet_samples);
}

TEST(ShadowMotion, ALampNearWhatMovesThrowsItsShadowFaster) {
    for (LightType const type : {LightType::point, LightType::spot}) {
        Vec3 const velocity(1, 0.5f, -0.5f), at(0, 0, 15);
        Scene scene = floor_scene();
        Index const node = add(scene, board(edge / 5, velocity));
        move(scene, node, velocity);
        add_light(scene, lamp(type, 3000), at, {0, 0, -1});
        Framelet const framelet = render(scene).framelet;
        ASSERT_EQ(framelet.drift.size(), std::size_t{framelet_samples});
        for (std::uint32_t i = 0; i < framelet_samples; ++i) {
            Vec3 const along = position_of(i) - at;
            Vec3 const expected = 5.0f * (velocity - along * (velocity.z / along.z));
            EXPECT_LT(glm::length(framelet.drift[i].velocity - (position_of(i).x < edge ? expected : Vec3(0))), 0.04f)
                << i;
        }
    }
}

TEST(ShadowMotion, WithALampThatMovesAlongTheShadowDoesAsWell) {
    Vec3 const velocity(1, 0.5f, 0), at(0, 0, 15);
    Scene scene = floor_scene();
    Index const node = add(scene, board(edge / 5, velocity));
    move(scene, node, velocity);
    add_light(scene, lamp(LightType::point, 3000), at - static_cast<float>(moment) * velocity, {0, 0, -1});
    Node carrier;
    scene.nodes.insert(scene.nodes.begin(), carrier);
    for (std::size_t i = 1; i < scene.nodes.size(); ++i) {
        scene.nodes[i].parent = i == 1 ? none : 0; // the floor stays
    }
    scene.lights[0].node += 1;
    scene.clips[0].channels[0].node = 0;
    Framelet const framelet = render(scene).framelet;
    ASSERT_EQ(framelet.drift.size(), std::size_t{framelet_samples});
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        EXPECT_LT(glm::distance(framelet.drift[i].velocity, position_of(i).x < edge ? velocity : Vec3(0)), 1e-2f) << i;
    }
}

TEST(ShadowMotion, WhatDeformsThrowsShadowsThatMoveAsWell) {
    Scene scene = floor_scene();
    Primitive primitive = board(edge - 6, {3, 1, -0.5f});
    primitive.morph_targets.resize(1);
    primitive.morph_targets[0].positions.assign(4, Vec3(6, 2, -1));
    Index const node = add(scene, std::move(primitive));
    scene.clips.resize(1);
    scene.clips[0].duration = 2;
    scene.clips[0].channels.push_back(
        {node, AnimatedProperty::morph_weights, Interpolation::linear, 1, {0, 2}, {0, 1}});
    add_light(scene, lamp(LightType::directional, 3), Vec3(0), {1, 0, -2});
    Framelet const framelet = render(scene).framelet;
    ASSERT_EQ(framelet.drift.size(), std::size_t{framelet_samples});
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        Vec3 const expected = position_of(i).x < edge ? Vec3(2.75f, 1, 0) : Vec3(0);
        EXPECT_LT(glm::distance(framelet.drift[i].velocity, expected), 1e-2f) << i;
    }
}

TEST(ShadowMotion, WhatStandsAndIsInTheWayTooKeepsTheShadowThere) {
    for (float const height : {1.0f, -1.0f}) { // behind and before what moves
        Scene scene = sunny_scene({3, 1, -0.5f});
        add(scene, quad(Vec3(-40, -20, 12 + height), {60, 0, 0}, {0, 40, 0}, 0));
        Framelet const framelet = render(scene).framelet;
        EXPECT_TRUE(framelet.drift.empty());
        EXPECT_EQ(framelet.red[0], 0);
    }
}

/// The shadow of a ball that turns about `axis` as it goes, by `turning` radians a second.
Framelet shadow_of_ball(Vec3 const& axis, float turning) {
    Scene scene = floor_scene();
    Index const ball = add(scene, sphere(Vec3(0), 4, 0));
    scene.clips.resize(1);
    scene.clips[0].duration = 2;
    float const half = 0.05f * turning; // half the angle that it turns in a tenth of a second
    Vec3 const turned = std::sin(half) * axis;
    scene.clips[0].channels = {
        {ball, AnimatedProperty::translation, Interpolation::linear, 3, {0, 2}, {-6.5f, 0, 16, -4.5f, 0, 16}},
        {ball,
         AnimatedProperty::rotation,
         Interpolation::linear,
         4,
         {0.2f, 0.3f},
         {0, 0, 0, 1, turned.x, turned.y, turned.z, std::cos(half)}}};
    add_light(scene, lamp(LightType::directional, 3), Vec3(0), {1, 0, -2});
    return render(scene).framelet;
}

TEST(ShadowMotion, WhatRollsThrowsAShadowThatGoesWithItsMiddle) {
    Vec3 const to_light = glm::normalize(Vec3(-1, 0, 2));
    for (bool const spins : {false, true}) {
        // A ball that turns slowly, so that its points go along the light or against it, or fast, about any axis.
        Framelet const framelet = spins ? shadow_of_ball(to_light, 8) : shadow_of_ball({0, 1, 0}, 1);
        ASSERT_EQ(framelet.drift.size(), std::size_t{framelet_samples});
        int dark = 0;
        for (std::uint32_t i = 0; i < framelet_samples; ++i) {
            if (framelet.red[i] == 0) {
                ++dark;
                EXPECT_LT(glm::length(framelet.drift[i].velocity - Vec3(1, 0, 0)), 0.1f) << spins << i;
            }
        }
        EXPECT_GT(dark, 50);
    }
}

TEST(ShadowMotion, OnlyTheStrongestLightCounts) {
    Scene scene = sunny_scene({3, 1, -0.5f});
    add_light(scene, lamp(LightType::directional, 1), Vec3(0), {-1, 0, -2}); // its shadow is elsewhere
    EXPECT_FALSE(render(scene).framelet.drift.empty());
    scene.lights[1].intensity = 10;
    EXPECT_TRUE(render(scene).framelet.drift.empty());
}

TEST(ShadowMotion, WhatMovesItselfKeepsItsBody) {
    Scene scene = floor_scene();
    Vec3 const velocity(3, 1, -0.5f);
    Index const node = add(scene, board(edge - 6, velocity));
    move(scene, node, velocity);
    move(scene, 0, {1, 0, 0}); // the floor
    add_light(scene, lamp(LightType::directional, 3), Vec3(0), {1, 0, -2});
    Framelet const framelet = render(scene).framelet;
    EXPECT_FALSE(framelet.body.empty());
    EXPECT_TRUE(framelet.drift.empty());
}

TEST(ShadowMotion, AShadowFallsWhereLightThroughThePointMeetsThePlane) {
    RenderLight sun, low, bulb;
    sun.towards = {0, 0, 1};
    low.towards = glm::normalize(Vec3(1, 0, 0.01f));
    bulb.type = LightType::point;
    bulb.position = {0, 0, 4};
    Vec3 const up(0, 0, 1);
    EXPECT_EQ(shadow_of({1, 2, 3}, sun, Vec3(7, 0, 0), up), Vec3(1, 2, 0));
    EXPECT_LT(glm::distance(shadow_of({1, 0, 2}, bulb, Vec3(0), up), Vec3(2, 0, 0)), 1e-5f);
    EXPECT_FALSE(std::isfinite(shadow_of({1, 2, 3}, low, Vec3(0), up).x)) << "it leaps";
}

/// A board that turns about an upright axle through the light of a sun above; `turning`: radians a second.
Framelet shadow_of_turning_board(float turning) {
    Scene scene = floor_scene();
    Index const node = add(scene, quad({-40, -2, 12}, {80, 0, 0}, {0, 4, 0}, 0));
    scene.clips.resize(1);
    scene.clips[0].duration = 2;
    AnimationChannel turn{node, AnimatedProperty::rotation, Interpolation::linear, 4, {}, {}};
    for (int key = 0; key <= 40; ++key) {
        float const half = 0.5f * turning * (static_cast<float>(key) * 0.05f - static_cast<float>(moment));
        turn.times.push_back(static_cast<float>(key) * 0.05f);
        turn.values.insert(turn.values.end(), {0, 0, std::sin(half), std::cos(half)});
    }
    scene.clips[0].channels = {turn};
    add_light(scene, lamp(LightType::directional, 3), Vec3(0), {0, 0, -1});
    return render(scene).framelet;
}

TEST(ShadowMotion, TheShadowOfWhatTurnsInPlaceTurnsAsItDoes) {
    for (float const turning : {3.0f, 9.0f, 15.0f}) {
        Framelet const framelet = shadow_of_turning_board(turning);
        ASSERT_EQ(framelet.drift.size(), std::size_t{framelet_samples});
        int dark = 0;
        float const cosine = std::cos(0.1f * turning), sine = std::sin(0.1f * turning);
        for (std::uint32_t i = 0; i < framelet_samples; ++i) {
            if (framelet.red[i] == 0) {
                Vec3 const at = position_of(i);
                Vec3 const after(cosine * at.x - sine * at.y, sine * at.x + cosine * at.y, 0);
                float const most = framelet.drift[i].jerk * 0.001f / 6;
                EXPECT_LT(glm::distance(Vec3(at.x, at.y, 0) + framelet.drift[i].after(0.1f), after),
                          1.1f * most + 2e-3f)
                    << i;
                EXPECT_LT(most, 0.1f) << "metres, that a fifth of a turn may be off";
                ++dark;
            }
        }
        EXPECT_GT(dark, 16);
    }
}

} // namespace
} // namespace framelet
