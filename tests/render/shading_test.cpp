// Surfaces under known light have known radiance.
#include "server/render/trace/shading.h"

#include <gtest/gtest.h>

#include "scene_builder.h"

namespace framelet {
namespace {

using namespace test;

constexpr float pi = std::numbers::pi_v<float>;

struct Furnace {
    char const* name;
    float metallic, roughness, tolerance;
};

TEST(Shading, WhiteSphereInAWhiteFurnaceIsWhite) {
    // Rough metal is included: light that bounces between facets is accounted for. The tolerance is that of the tables.
    for (Furnace const& f :
         {Furnace{"matte", 0, 1, 0.005f}, Furnace{"plastic", 0, 0.3f, 0.005f}, Furnace{"mirror", 1, 0, 0.005f},
          Furnace{"brushed", 1, 0.4f, 0.005f}, Furnace{"rough metal", 1, 1, 0.005f}}) {
        Scene scene;
        Material white = matte(Vec3(1));
        white.metallic = f.metallic;
        white.roughness = f.roughness;
        scene.materials.push_back(white);
        add(scene, sphere(Vec3(0), 1, 0));
        RenderScene const ready(scene, Environment::uniform(Vec3(1)));
        for (float x : {0.0f, 0.3f, 0.6f, 0.9f, 0.97f}) {
            Seen const seen = look_along(ready, {x, 0.1f, 5}, {0, 0, -1});
            EXPECT_TRUE(std::isfinite(seen.depth));
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(seen.radiance[c], 1, f.tolerance) << f.name << " at " << x;
            }
        }
    }
}

/// A matte floor at y = 0 seen from above; `base` is its albedo. The view is far off the mirror direction, and the
/// reference includes the specular part by the same BRDF at that angle being small: tolerances are 3%.
Scene floor_scene(float base) {
    Scene scene;
    scene.materials.push_back(matte(Vec3(base)));
    add(scene, quad({-10, 0, 10}, {20, 0, 0}, {0, 0, -20}, 0));
    return scene;
}

float floor_radiance(Scene const& scene, Vec3 at) {
    RenderScene const ready(scene, black());
    return look_along(ready, at + Vec3(0, 5, 0), {0, -1, 0}).radiance.g;
}

/// Radiance of the floor per unit of irradiance, seen from straight above under light at this angle from vertical.
float floor_reflectance(float base, float cosine) {
    float const half_cosine = std::sqrt((1 + cosine) / 2); // between view and half vector
    float const fresnel = 0.04f + 0.96f * std::pow(1 - half_cosine, 5.0f);
    // Roughness 1: D = 1/pi, V = 0.5 / (cos + 1).
    float const visibility = 0.5f / (cosine + 1);
    AmbientShares const shares = ambient_shares(SplitSumTable().at(1, 1), Vec3(0.04f), Vec3(base));
    return shares.diffuse.g / pi + fresnel * visibility / pi;
}

TEST(Shading, DirectionalLightFollowsTheCosine) {
    for (float angle : {0.0f, 0.5f, 1.0f, 1.4f}) {
        Scene scene = floor_scene(0.5f);
        Light sun;
        sun.type = LightType::directional;
        sun.intensity = 3;
        add_light(scene, sun, {0, 9, 0}, {std::sin(angle), -std::cos(angle), 0});
        float const cosine = std::cos(angle);
        float const expected = 3 * cosine * floor_reflectance(0.5f, cosine);
        EXPECT_NEAR(floor_radiance(scene, {0, 0, 0}), expected, 0.002f * expected) << angle;
    }
}

TEST(Shading, PointLightFallsWithTheSquareOfDistance) {
    Scene scene = floor_scene(0.5f);
    Light lamp;
    lamp.intensity = 40;
    add_light(scene, lamp, {0, 2, 0}, {0, -1, 0});
    for (float x : {0.0f, 1.0f, 3.0f}) {
        float const squared = 4 + x * x;
        float const cosine = 2 / std::sqrt(squared);
        float const expected = 40 / squared * cosine * floor_reflectance(0.5f, cosine);
        EXPECT_NEAR(floor_radiance(scene, {x, 0, 0}), expected, 0.002f * expected) << x;
    }
}

TEST(Shading, RangeWindowsThePointLight) {
    Scene scene = floor_scene(0.5f);
    Light lamp;
    lamp.intensity = 40;
    lamp.range = 4;
    add_light(scene, lamp, {0, 2, 0}, {0, -1, 0});
    float const window = 1 - 1.0f / 16; // 1 - (2/4)^4
    float const expected = 10 * window * floor_reflectance(0.5f, 1);
    EXPECT_NEAR(floor_radiance(scene, {0, 0, 0}), expected, 0.002f * expected);
    EXPECT_EQ(floor_radiance(scene, {3.6f, 0, 0}), 0);
}

TEST(Shading, SpotLightKeepsToItsCone) {
    Scene scene = floor_scene(0.5f);
    Light spot;
    spot.type = LightType::spot;
    spot.intensity = 40;
    spot.inner_cone = 0.2f;
    spot.outer_cone = 0.5f;
    add_light(scene, spot, {0, 2, 0}, {0, -1, 0});
    for (float angle : {0.1f, 0.35f, 0.6f}) {
        float const cosine = std::cos(angle);
        float const ramp = (cosine - std::cos(0.5f)) / (std::cos(0.2f) - std::cos(0.5f));
        float const cone = std::clamp(ramp, 0.0f, 1.0f) * std::clamp(ramp, 0.0f, 1.0f);
        float const squared = 4 / (cosine * cosine);
        float const expected = 40 / squared * cosine * cone * floor_reflectance(0.5f, cosine);
        EXPECT_NEAR(floor_radiance(scene, {2 * std::tan(angle), 0, 0}), expected, 0.002f * expected + 1e-7f) << angle;
    }
}

TEST(Shading, ThingsCastShadowsFromBothSides) {
    for (bool turned : {false, true}) {
        Scene scene = floor_scene(0.5f);
        Light sun;
        sun.type = LightType::directional;
        sun.intensity = 3;
        add_light(scene, sun, {0, 9, 0}, {0, -1, 0});
        Vec3 const u(1, 0, 0), v(0, 0, -1);
        add(scene, quad({0, 1, 1}, turned ? v : u, turned ? u : v, 0));
        RenderScene const ready(scene, black());
        // The floor is looked at from the side, under the sheet.
        EXPECT_EQ(look_along(ready, {0.5f, 0.5f, 0.5f + 4}, {0, -0.125f, -1}).radiance.g, 0);
        EXPECT_GT(look_along(ready, {-0.5f, 0.5f, 0.5f + 4}, {0, -0.125f, -1}).radiance.g, 0.3f);
    }
}

TEST(Shading, SurfacesDoNotShadowThemselvesAtAnyScale) {
    for (float scale : {0.01f, 1.0f, 1000.0f}) {
        for (float away : {0.0f, 2000.0f}) {
            if (scale < 1 && away > 0) {
                continue; // finer than single precision tells apart out there
            }
            Scene scene;
            scene.materials.push_back(matte(Vec3(0.5f)));
            Transform place;
            place.scale = Vec3(scale);
            place.translation = Vec3(away, 0.3f * away, -away);
            add(scene, sphere(Vec3(0), 1, 0, 10), place);
            Light sun;
            sun.type = LightType::directional;
            sun.intensity = 1;
            add_light(scene, sun, {0, 0, 0}, {0, 0, -1});
            RenderScene const ready(scene, black());
            // Light from the viewer: everything seen is lit, and smoothly so, facets or not.
            for (int i = -19; i <= 19; ++i) {
                for (int j = -19; j <= 19; ++j) {
                    float const x = static_cast<float>(i) / 21, y = static_cast<float>(j) / 21;
                    if (x * x + y * y > 0.85f) {
                        continue;
                    }
                    Seen const seen =
                        look_along(ready, Vec3(place.translation) + scale * Vec3(x, y, 5), Vec3(0, 0, -scale));
                    float const cosine = std::sqrt(1 - x * x - y * y);
                    EXPECT_NEAR(seen.radiance.g, 0.5f / pi * cosine, 0.03f)
                        << scale << ' ' << away << ' ' << x << ' ' << y;
                }
            }
        }
    }
}

TEST(Shading, SmoothLowPolySphereHasACleanTerminator) {
    Scene scene;
    scene.materials.push_back(matte(Vec3(0.5f)));
    add(scene, sphere(Vec3(0), 1, 0, 8));
    Light sun;
    sun.type = LightType::directional;
    sun.intensity = pi;
    add_light(scene, sun, {0, 0, 0}, {-1, 0, -0.2f});
    RenderScene const ready(scene, black());
    Vec3 const towards = glm::normalize(Vec3(1, 0, 0.2f));
    // A walk across the terminator: wherever the smooth normal sees the sun clearly there is light.
    for (int i = 0; i < 120; ++i) {
        float const x = -0.15f + 0.5f * static_cast<float>(i) / 120;
        float const y = 0.07f;
        Vec3 const normal(x, y, std::sqrt(1 - x * x - y * y));
        float const cosine = glm::dot(normal, towards);
        float const seen = look_along(ready, {x, y, 5}, {0, 0, -1}).radiance.g;
        if (cosine > 0.15f) {
            EXPECT_GT(seen, 0.25f * cosine) << x;
        }
    }
}

TEST(Shading, NoLightLeaksThroughAClosedBox) {
    Scene scene;
    scene.materials.push_back(matte(Vec3(1)));
    scene.materials[0].double_sided = true;
    float const s = 3;
    Vec3 const corners[3] = {{s, 0, 0}, {0, s, 0}, {0, 0, s}};
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 const u = corners[(axis + 1) % 3], v = corners[(axis + 2) % 3];
        add(scene, quad(Vec3(700), u, v, 0));
        add(scene, quad(Vec3(700) + corners[axis], u, v, 0));
    }
    Light sun;
    sun.type = LightType::directional;
    sun.intensity = 100;
    add_light(scene, sun, {0, 0, 0}, {-0.4f, -0.7f, -0.3f});
    RenderScene const ready(scene, black());
    for (int i = 0; i < 400; ++i) {
        float const a = static_cast<float>(i) * 0.7f, b = static_cast<float>(i) * 0.37f;
        Vec3 const direction(std::sin(a) * std::cos(b), std::sin(b), std::cos(a) * std::cos(b));
        Seen const seen = look_along(ready, Vec3(701.5f), direction);
        EXPECT_TRUE(std::isfinite(seen.depth));
        EXPECT_EQ(seen.radiance.g, 0) << i;
    }
}

TEST(Shading, UnlitShowsItsColourAndEmissiveGlows) {
    Scene scene;
    Material unlit = matte({0.2f, 0.4f, 0.6f});
    unlit.unlit = true;
    Material lamp = matte(Vec3(0));
    lamp.emissive = {3, 2, 1};
    scene.materials = {unlit, lamp};
    add(scene, quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 0));
    add(scene, quad({3, -1, 0}, {2, 0, 0}, {0, 2, 0}, 1));
    RenderScene const ready(scene, black());
    EXPECT_EQ(look_along(ready, {0, 0, 1}, {0, 0, -1}).radiance, Vec3(0.2f, 0.4f, 0.6f));
    EXPECT_EQ(look_along(ready, {4, 0, 1}, {0, 0, -1}).radiance, Vec3(3, 2, 1));
}

TEST(Shading, UnlitColoursAreNotBentByExposureAndToneCurve) {
    Scene scene;
    Material unlit = matte({0.2f, 0.4f, 0.95f});
    unlit.unlit = true;
    scene.materials = {unlit};
    add(scene, quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 0));
    RenderScene ready(scene, black());
    for (DisplayTransform const& display : {DisplayTransform(0.01f), DisplayTransform(30, ToneCurve::linear)}) {
        ready.set_display(display);
        Vec3 const shown = display.shown(look_along(ready, {0, 0, 1}, {0, 0, -1}).radiance);
        EXPECT_LT(glm::distance(shown, Vec3(0.2f, 0.4f, 0.95f)), 1e-4f);
    }
}

TEST(Shading, OcclusionDarkensTheSurroundingsOnly) {
    auto radiance = [](bool sun, int occlusion) {
        Scene scene;
        scene.materials.push_back(matte(Vec3(0.5f)));
        Index const map = add_texture(scene, 1, 1, [&](int, int) {
            return std::array<std::uint8_t, 4>{static_cast<std::uint8_t>(occlusion), 255, 255, 255};
        });
        scene.materials[0].occlusion_texture.texture = map;
        add(scene, quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 0));
        if (sun) {
            Light light;
            light.type = LightType::directional;
            add_light(scene, light, {0, 0, 0}, {0, 0, -1});
        }
        RenderScene const ready(scene, Environment::uniform(Vec3(sun ? 0.0f : 1.0f)));
        return look_along(ready, {0, 0, 1}, {0, 0, -1}).radiance.g;
    };
    EXPECT_NEAR(radiance(false, 51), 0.2f * radiance(false, 255), 1e-3f);
    EXPECT_EQ(radiance(true, 51), radiance(true, 255));
}

TEST(Shading, VertexColoursMultiplyTheBaseColour) {
    Scene scene;
    Material unlit = matte(Vec3(0.5f));
    unlit.unlit = true;
    scene.materials.push_back(unlit);
    Primitive p = quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 0);
    p.colors = {{0, 0, 0, 1}, {1, 0, 0, 1}, {1, 1, 0, 1}, {0, 1, 0, 1}};
    add(scene, p);
    RenderScene const ready(scene, black());
    Vec3 const seen = look_along(ready, {0.5f, -0.5f, 1}, {0, 0, -1}).radiance;
    EXPECT_NEAR(seen.r, 0.375f, 1e-5f);
    EXPECT_NEAR(seen.g, 0.125f, 1e-5f);
    EXPECT_EQ(seen.b, 0);
}

TEST(Shading, NormalMapTiltsTowardsUAndAgainstV) {
    // A normal map that leans to +x (right in the picture) reflects light from the right; +y leans up.
    auto radiance = [](std::array<std::uint8_t, 4> texel, Vec3 shines, bool tangents, float mirror) {
        Scene scene;
        scene.materials.push_back(matte(Vec3(0.5f)));
        scene.materials[0].double_sided = true;
        scene.materials[0].normal_texture.texture = add_texture(scene, 1, 1, [&](int, int) { return texel; });
        Primitive p = quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 0);
        p.uv[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}}; // upright picture: v points down
        if (tangents) {
            p.tangents.assign(4, Vec4(1, 0, 0, 1));
        }
        Transform place;
        place.scale = {mirror, 1, 1};
        add(scene, p, place);
        Light light;
        light.type = LightType::directional;
        add_light(scene, light, {0, 0, 0}, shines);
        RenderScene const ready(scene, black());
        return look_along(ready, {0, 0, 1}, {0, 0, -1}).radiance.g;
    };
    std::array<std::uint8_t, 4> const right{218, 128, 218, 255}, up{128, 218, 218, 255};
    for (bool tangents : {true, false}) {
        EXPECT_GT(radiance(right, {-1, 0, -1}, tangents, 1), 1.5f * radiance(right, {1, 0, -1}, tangents, 1));
        EXPECT_GT(radiance(up, {0, -1, -1}, tangents, 1), 1.5f * radiance(up, {0, 1, -1}, tangents, 1));
        // A mirrored instance shows the mirror image of the bumps.
        EXPECT_GT(radiance(right, {1, 0, -1}, tangents, -1), 1.5f * radiance(right, {-1, 0, -1}, tangents, -1));
        EXPECT_GT(radiance(up, {0, -1, -1}, tangents, -1), 1.5f * radiance(up, {0, 1, -1}, tangents, -1));
    }
}

TEST(Shading, DefaultLightExposesMiddleGreyWell) {
    Scene scene;
    scene.materials.push_back(matte(Vec3(0.5f)));
    add(scene, sphere(Vec3(0), 1, 0));
    RenderScene const ready(scene, std::nullopt);
    float const lit = look_along(ready, {0.3f, 0.4f, 5}, {0, 0, -1}).radiance.g;
    EXPECT_GT(lit, 0.3f);
    EXPECT_LT(lit, 0.8f);
    EXPECT_GT(look_along(ready, {0, 0, 5}, {0, 1, -1}).radiance.b, 0.1f); // the sky
}

} // namespace
} // namespace framelet
