#include "server/render/first_look.h"

#include <limits>

#include <gtest/gtest.h>

#include "scene_builder.h"
#include "server/render/path/path_light.h"
#include "server/render/prepared/prepared_scene.h"

namespace framelet::test {
namespace {

Camera const in_front = look_at({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 0.8f);

Scene lit_sphere(float intensity, Vec3 color = Vec3(0.5f)) {
    Scene scene;
    scene.materials = {matte(color)};
    add(scene, sphere(Vec3(0), 1, 0));
    Light lamp;
    lamp.type = LightType::point;
    lamp.intensity = intensity;
    add_light(scene, lamp, {0, 0, 4}, {0, 0, -1});
    return scene;
}

float exposure_of(Scene const& scene, Environment environment) {
    RenderScene const ready(scene, std::move(environment));
    return auto_exposure(ready, in_front);
}

TEST(FirstLook, ExposureLeavesGoodLightAloneAndMendsTheRest) {
    auto const exposure = [](float intensity) { return exposure_of(lit_sphere(intensity), black()); };
    EXPECT_EQ(exposure(20), 1);
    float const bright = exposure(1e5f);
    EXPECT_LT(bright, 0.01f);
    EXPECT_NEAR(exposure(2e5f), bright / 2, 0.01f * bright);
    EXPECT_GT(exposure(0.01f), 10);
    EXPECT_EQ(exposure(0), 1);
    Scene const nothing;
    RenderScene const empty(nothing, std::nullopt);
    EXPECT_EQ(auto_exposure(empty, Camera{}), 1);
}

/// A look whose hits have red `dark` and, as many as `share` of them, red `bright`; a quarter of it is background.
FirstLook look_of(float dark, float bright, float share, float background) {
    FirstLook look(1);
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        bool const hit = i % 4 != 0;
        look[0].red[i] = !hit ? background : float(i) < share * framelet_samples ? bright : dark;
        look[0].green[i] = look[0].blue[i] = 0.5f * look[0].red[i];
        look[0].depth[i] = hit ? 1 : std::numeric_limits<float>::infinity();
    }
    return look;
}

TEST(FirstLook, NeitherWhatIsHitNorBackgroundIsBurnt) {
    EXPECT_EQ(auto_exposure(look_of(0.4f, 0.8f, 0.2f, 0.9f)), 1);
    EXPECT_NEAR(auto_exposure(look_of(0.4f, 1.8f, 0.2f, 0.9f)), 0.5f, 1e-3f) << "a fifth of the walls would be white";
    EXPECT_EQ(auto_exposure(look_of(0.4f, 50, 0.05f, 0.9f)), 1) << "a lamp may be white";
    EXPECT_NEAR(auto_exposure(look_of(0.4f, 0.8f, 0.2f, 1.6f)), 1 / 1.6f, 1e-3f);
    EXPECT_NEAR(auto_exposure(look_of(0.4f, 0.8f, 0.2f, 100)), 0.5f, 1e-3f) << "the sky behind a window may be white";
}

TEST(FirstLook, WhatIsAllDarkIsLifted) {
    EXPECT_NEAR(auto_exposure(look_of(0.05f, 0.1f, 0.3f, 0.02f)), 2, 1e-3f);
    EXPECT_EQ(auto_exposure(look_of(0.05f, 0.3f, 0.2f, 0.02f)), 1) << "a lamp at night lights what it lights";
}

TEST(FirstLook, AScaleOfAllLightCancels) {
    for (float const scale : {1e-6f, 1e-3f, 1e3f, 1e6f}) {
        FirstLook const look = look_of(0.3f * scale, 0.7f * scale, 0.2f, 0.5f * scale);
        EXPECT_NEAR(auto_exposure(look) * scale, auto_exposure(look_of(300, 700, 0.2f, 500)) * 1000, 1e-3f);
    }
}

TEST(FirstLook, BouncedLightShowsInABoxAndNotOnABall) {
    auto const difference = [](Scene const& scene) {
        RenderScene const ready(scene, black());
        PathLight const paths(ready.prepared(), {});
        return shown_difference(take_first_look(ready, in_front), take_first_look(ready, in_front, &paths), 1);
    };
    EXPECT_LT(difference(lit_sphere(20)), 1);
    Scene box = lit_sphere(20, Vec3(0.8f));
    Vec3 const low(-3), x(6, 0, 0), y(0, 6, 0), z(0, 0, 9);
    for (Primitive const& wall : {quad(low, x, y, 0), quad(low, z, x, 0), quad(low, y, z, 0), quad(low + y, x, z, 0),
                                  quad(low + x, z, y, 0), quad(low + z, y, x, 0)}) {
        add(box, wall);
    }
    EXPECT_GT(difference(box), 10);
}

} // namespace
} // namespace framelet::test
