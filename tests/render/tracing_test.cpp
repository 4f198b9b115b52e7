// Tests what rays pass, which is cut-outs, see-through and single-sided surfaces, and mirrors.
#include "server/render/trace/tracing.h"

#include <gtest/gtest.h>

#include "scene_builder.h"

namespace framelet {
namespace {

using namespace test;

Material glowing(Vec3 color) {
    Material m = matte(color);
    m.unlit = true;
    return m;
}

/// A 2x2 sheet about (0, 0, z) that faces +Z.
Primitive sheet(float z, Index material) {
    return quad({-1, -1, z}, {2, 0, 0}, {0, 2, 0}, material);
}

TEST(Tracing, BackgroundOnlyWhereThereIsNothing) {
    Scene const scene;
    RenderScene const ready(scene, Environment::uniform({1, 2, 3}));
    Seen const seen = look_along(ready, Vec3(0), {0, 0, -1});
    EXPECT_EQ(seen.radiance, Vec3(1, 2, 3));
    EXPECT_TRUE(std::isinf(seen.depth));
}

TEST(Tracing, MaskLetsRaysAndLightThroughItsHoles) {
    Scene scene;
    Material leaf = glowing({0, 1, 0});
    leaf.alpha_mode = AlphaMode::mask;
    leaf.base_color_texture.texture = add_texture(scene, 2, 1, [](int x, int) {
        return std::array<std::uint8_t, 4>{255, 255, 255, static_cast<std::uint8_t>(x == 0 ? 255 : 0)};
    });
    scene.textures[0].nearest = true;
    scene.materials = {leaf, matte(Vec3(0.5f))};
    add(scene, sheet(1, 0));
    add(scene, sheet(0, 1));
    Light sun;
    sun.type = LightType::directional;
    sun.intensity = 3;
    add_light(scene, sun, {0, 0, 5}, {0, 0, -1});
    RenderScene const ready(scene, black());
    Seen const leaf_seen = look_along(ready, {-0.5f, 0, 3}, {0, 0, -1});
    EXPECT_EQ(leaf_seen.radiance, Vec3(0, 1, 0));
    EXPECT_NEAR(leaf_seen.depth, 2, 1e-5f);
    Seen const through = look_along(ready, {0.5f, 0, 3}, {0, 0, -1});
    EXPECT_NEAR(through.depth, 3, 1e-5f);
    EXPECT_GT(through.radiance.g, 0.3f); // lit through the hole
    // The part of the sheet below the leaf itself, looked at from between the two.
    EXPECT_EQ(look_along(ready, {-0.5f, 0, 0.5f}, {0, 0, -1}).radiance.g, 0);
}

TEST(Tracing, BlendCompositesFrontToBack) {
    Scene scene;
    Material red = glowing({1, 0, 0}), green = glowing({0, 1, 0});
    red.alpha_mode = green.alpha_mode = AlphaMode::blend;
    red.base_color.a = 0.25f;
    green.base_color.a = 0.5f;
    scene.materials = {red, green};
    add(scene, sheet(1, 0));
    add(scene, sheet(0, 1));
    RenderScene const ready(scene, Environment::uniform({0, 0, 1}));
    Seen const seen = look_along(ready, {0, 0, 3}, {0, 0, -1});
    EXPECT_NEAR(seen.radiance.r, 0.25f, 1e-5f);
    EXPECT_NEAR(seen.radiance.g, 0.75f * 0.5f, 1e-5f);
    EXPECT_NEAR(seen.radiance.b, 0.75f * 0.5f, 1e-5f);
    EXPECT_NEAR(seen.depth, 3, 1e-5f); // the layer that weighs most; of equals the nearer
}

TEST(Tracing, ManySeeThroughLayersEnd) {
    Scene scene;
    Material haze = glowing({1, 1, 1});
    haze.alpha_mode = AlphaMode::blend;
    haze.base_color.a = 0;
    scene.materials = {haze};
    for (int i = 0; i < 100; ++i) {
        add(scene, sheet(-static_cast<float>(i), 0));
    }
    RenderScene const ready(scene, Environment::uniform({0, 0, 1}));
    EXPECT_EQ(look_along(ready, {0, 0, 3}, {0, 0, -1}).radiance, Vec3(0, 0, 1));
}

TEST(Tracing, ShadowsThroughBlendAreTheProductOfWhatPasses) {
    auto radiance = [](int panes) {
        Scene scene;
        Material pane = matte(Vec3(0));
        pane.alpha_mode = AlphaMode::blend;
        pane.base_color.a = 0.3f;
        scene.materials = {pane, matte(Vec3(0.5f))};
        for (int i = 0; i < panes; ++i) {
            add(scene, sheet(1 + 0.1f * static_cast<float>(i), 0));
        }
        add(scene, sheet(0, 1));
        Light sun;
        sun.type = LightType::directional;
        sun.intensity = 3;
        add_light(scene, sun, {0, 0, 5}, {0, 0, -1});
        RenderScene const ready(scene, black());
        return look_along(ready, {0.2f, 0.1f, 0.5f}, {0, 0, -1}).radiance.g; // from below the panes
    };
    float const open = radiance(0);
    EXPECT_NEAR(radiance(1), 0.7f * open, 1e-4f);
    EXPECT_NEAR(radiance(2), 0.49f * open, 1e-4f);
    EXPECT_NEAR(radiance(3), 0.343f * open, 1e-4f);
}

TEST(Tracing, TransmissionShowsWhatIsBehindTintedByTheBaseColour) {
    Scene scene;
    Material glass = matte({1, 0.5f, 0});
    glass.transmission = 1;
    scene.materials = {glass, glowing(Vec3(1))};
    add(scene, sheet(1, 0));
    add(scene, sheet(0, 1));
    RenderScene const ready(scene, black());
    Vec3 const seen = look_along(ready, {0, 0, 3}, {0, 0, -1}).radiance;
    EXPECT_NEAR(seen.r, 0.96f, 1e-4f);
    EXPECT_NEAR(seen.g, 0.48f, 1e-4f);
    EXPECT_NEAR(seen.b, 0, 1e-4f);
}

TEST(Tracing, SingleSidedSurfacesAreInvisibleFromBehind) {
    for (float mirror : {1.0f, -1.0f}) {
        Scene scene;
        Material both = glowing({0, 1, 0});
        both.double_sided = true;
        scene.materials = {glowing({1, 0, 0}), both};
        Transform place;
        place.scale = {mirror, 1, 1}; // faces the same way: winding follows the mesh's own space
        add(scene, sheet(0, 0), place);
        add(scene, sheet(-1, 1), place);
        RenderScene const ready(scene, Environment::uniform({0, 0, 1}));
        EXPECT_EQ(look_along(ready, {0, 0, 3}, {0, 0, -1}).radiance, Vec3(1, 0, 0)) << mirror;
        EXPECT_EQ(look_along(ready, {0, 0, -0.5f}, {0, 0, 1}).radiance, Vec3(0, 0, 1)) << mirror;
        EXPECT_EQ(look_along(ready, {0, 0, -3}, {0, 0, 1}).radiance, Vec3(0, 1, 0)) << mirror;
    }
}

TEST(Tracing, TrianglesDoubledTheOtherWayRoundShowOneSideEach) {
    Scene scene;
    scene.materials = {glowing({1, 0, 0}), glowing({0, 1, 0})};
    Primitive const front = quad({-1, -1, 0}, {2, 0, 0.3f}, {0.1f, 2, 0}, 0);
    Primitive back = front;
    back.material = 1;
    for (auto& triangle : back.triangles) {
        std::swap(triangle[1], triangle[2]);
    }
    add(scene, front);
    add(scene, back);
    RenderScene const ready(scene, black());
    for (int i = 0; i < 100; ++i) {
        Vec3 const at(-0.8f + 0.015f * static_cast<float>(i), 0.6f - 0.011f * static_cast<float>(i), 0);
        EXPECT_EQ(look_along(ready, at + Vec3(0, 0, 3), {0, 0, -1}).radiance, Vec3(1, 0, 0));
        EXPECT_EQ(look_along(ready, at - Vec3(0, 0, 3), {0, 0, 1}).radiance, Vec3(0, 1, 0));
    }
}

TEST(Tracing, MirrorShowsTheMirroredObjectInItsPlace) {
    Scene scene;
    Material mirror = matte(Vec3(1));
    mirror.metallic = 1;
    mirror.roughness = 0;
    scene.materials = {mirror, glowing({1, 0, 0})};
    add(scene, quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, 0)); // floor
    add(scene, sphere({1, 1, -2}, 0.5f, 1));
    RenderScene const ready(scene, Environment::uniform({0, 0, 1}));
    // Aim at the mirror image of the sphere, below the floor.
    Vec3 const eye(0, 2, 3);
    Vec3 const image(1, -1, -2);
    Seen const seen = look_along(ready, eye, image - eye);
    EXPECT_NEAR(seen.radiance.r, 1, 0.02f);
    EXPECT_NEAR(seen.radiance.b, 0, 0.02f);
    EXPECT_NEAR(seen.depth, 2.0f / 3, 1e-5f); // the floor's own
    Seen const beside = look_along(ready, eye, image + Vec3(0.8f, 0, 0) - eye);
    EXPECT_NEAR(beside.radiance.b, 1, 0.02f);
    EXPECT_NEAR(beside.radiance.r, 0, 0.02f);
}

TEST(Tracing, FacingMirrorsEnd) {
    Scene scene;
    Material mirror = matte(Vec3(1));
    mirror.metallic = 1;
    mirror.roughness = 0;
    mirror.double_sided = true;
    scene.materials = {mirror};
    add(scene, sheet(0, 0));
    add(scene, sheet(1, 0));
    RenderScene const ready(scene, Environment::uniform(Vec3(1)));
    EXPECT_NEAR(look_along(ready, {0, 0, 0.5f}, {0.1f, 0.05f, -1}).radiance.g, 1, 0.01f);
}

} // namespace
} // namespace framelet
