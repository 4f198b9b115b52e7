// Shadows of lights with a size have known penumbras.
#include "server/render/trace/lamp_shadows.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "scene_builder.h"
#include "server/render/cache/light_cache.h"

namespace framelet {
namespace {

using namespace test;

/// A floor at y = 0 below a sun at the zenith; a ceiling at y = 1 hides it where x < 0.
Scene half_roofed(bool has_roof) {
    Scene scene;
    scene.materials.push_back(matte(Vec3(0.5f)));
    add(scene, quad({-10, 0, 10}, {20, 0, 0}, {0, 0, -20}, 0));
    if (has_roof) {
        add(scene, quad({-10, 1, 10}, {10, 0, 0}, {0, 0, -20}, 0));
    }
    Light sun;
    sun.type = LightType::directional;
    sun.intensity = 3;
    add_light(scene, sun, {0, 9, 0}, {0, -1, 0});
    return scene;
}

/// Share of a disc of radius 1 that lies beyond a line at a distance of its centre.
float beyond(float line) {
    float const at = std::clamp(line, -1.0f, 1.0f);
    return (std::acos(at) - at * std::sqrt(1 - at * at)) / std::numbers::pi_v<float>;
}

struct Roof : ::testing::Test {
    static constexpr Viewport viewport{64, 64};
    ImagePlane plane{viewport};
    Camera camera = look_at({0, 0.9f, 0}, {0, 0, 0}, {0, 0, -1}, std::numbers::pi_v<float> / 3);
    Scene open_scene = half_roofed(false), scene = half_roofed(true);
    RenderScene open{open_scene, black()}, ready{scene, black()};
    LightCache nothing{1};
    std::uint32_t rays = 0;

    /// Calls `see(x, SHARE)` for each sample of the picture: where it lies on the floor, what share of the sun shines
    /// there.
    template <class See>
    void look(LampSizes sizes, See see) {
        ready.set_light(&nothing, sizes);
        ViewRays const view = make_view_rays(camera, viewport);
        rays = 0;
        Framelet lit, shaded;
        for (std::uint32_t code = 1u << (2 * plane.pixel_depth()); code < 2u << (2 * plane.pixel_depth()); ++code) {
            render_framelet(open, view, plane, {code}, lit);
            rays += render_framelet(ready, view, plane, {code}, shaded);
            PixelRect const rect = plane.tile_rect({code});
            for (std::uint32_t i = 0; i < framelet_samples; ++i) {
                Vec2 const at(static_cast<float>(rect.left) + static_cast<float>(morton_x(i)) + 0.5f,
                              static_cast<float>(rect.top) + static_cast<float>(morton_y(i)) + 0.5f);
                Vec3 const towards = view.direction + view.direction_dx * at.x + view.direction_dy * at.y;
                see((camera.position - towards * (camera.position.y / towards.y)).x, shaded.green[i] / lit.green[i]);
            }
        }
        ready.set_light(nullptr, {});
    }
};

TEST_F(Roof, OfAHardSunIsAHardShadow) {
    look({}, [](float x, float share) { EXPECT_NEAR(share, x < 0 ? 0 : 1, std::abs(x) < 0.01f ? 1 : 1e-4f) << x; });
    EXPECT_EQ(rays, 2u * viewport.width * viewport.height);
}

/// The lanes' rays look at sixteen points of the sun, and smoothing makes one share of all of them.
TEST_F(Roof, OfALargeSunIsAWidePenumbra) {
    constexpr float tangent = 0.4f;
    double bias = 0, worst = 0;
    int counted = 0;
    look({.sun = std::atan(tangent)}, [&](float x, float share) {
        float const expected = beyond(-x / tangent);
        bias += share - expected;
        worst = std::max(worst, static_cast<double>(std::abs(share - expected)));
        ++counted;
    });
    EXPECT_NEAR(bias / counted, 0, 0.01);
    EXPECT_LT(worst, 0.12) << "single rays would be off by 0.5";
}

TEST_F(Roof, OfARealSunIsNarrowAndCostsLittle) {
    float const tangent = std::tan(0.00925f / 2);
    look({.sun = std::atan(tangent)}, [&](float x, float share) {
        if (std::abs(x) > 0.04f) { // beyond the packet in which the edge is
            EXPECT_NEAR(share, x < 0 ? 0 : 1, 1e-4f) << x;
        }
    });
    EXPECT_LT(rays, 2.3 * viewport.width * viewport.height) << "only where the shadow ends there are more";
}

TEST_F(Roof, OfALampWithASizeEndsAtItsSurface) {
    // The lamp hangs in a shell that is smaller than itself: it shines, as if the shell were its glass.
    Scene lamp_scene;
    lamp_scene.materials.push_back(matte(Vec3(0.5f)));
    lamp_scene.materials[0].double_sided = true;
    add(lamp_scene, quad({-10, 0, 10}, {20, 0, 0}, {0, 0, -20}, 0));
    add(lamp_scene, sphere({0, 2, 0}, 0.05f, 0));
    Light bulb;
    bulb.type = LightType::point;
    add_light(lamp_scene, bulb, {0, 2, 0}, {0, -1, 0});
    RenderScene lamp(lamp_scene, black());
    Framelet floor;
    auto const lit = [&] {
        render_framelet(lamp, make_view_rays(camera, viewport), plane, {1u << (2 * plane.pixel_depth())}, floor);
        return std::ranges::count_if(floor.green, [](float light) { return light > 0; });
    };
    EXPECT_LT(lit(), 8) << "a ray may slip between two triangles";
    lamp.set_light(&nothing, {.lamp = 0.1f});
    EXPECT_EQ(lit(), framelet_samples);
    lamp.set_light(nullptr, {});
}

} // namespace
} // namespace framelet
