// Light that paths find, against what is known of it by mathematics.
#include "server/render/path/path_tracing.h"

#include <algorithm>
#include <random>
#include <utility>

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include "box_scene.h"
#include "scene_builder.h"
#include "server/render/path/path_picture.h"
#include "server/render/path/path_random.h"

namespace framelet {
namespace {

using namespace test;

constexpr float pi = std::numbers::pi_v<float>;

/// Mean radiance along a ray.
Vec3 look(PathScene const& scene, Vec3 origin, Vec3 direction, PathOptions const& options) {
    constexpr int most = 64; // packets a block
    int const packets = (options.paths + lanes - 1) / lanes;
    std::vector<glm::dvec3> sums(static_cast<std::size_t>((packets + most - 1) / most), glm::dvec3(0));
    tbb::parallel_for(std::size_t(0), sums.size(), [&](std::size_t block) {
        int const first = static_cast<int>(block) * most;
        for (int packet = first; packet < std::min(first + most, packets); ++packet) {
            RayPacket rays{};
            rays.origin.fill(origin);
            rays.direction.fill(direction);
            rays.far.fill(INFINITY);
            PathNumbers numbers;
            for (int i = 0; i < lanes; ++i) {
                numbers.pixel_seed[i] = hashed(options.seed, 77);
                numbers.sample[i] = static_cast<std::uint32_t>(packet * lanes + i);
            }
            LaneVec3 radiance;
            trace_paths(scene, options, rays, all_lanes, Footprint{}, numbers, radiance);
            for (int i = 0; i < lanes; ++i) {
                sums[block] += glm::dvec3(radiance.get(i));
            }
        }
    });
    glm::dvec3 sum(0);
    for (glm::dvec3 const& part : sums) {
        sum += part;
    }
    return Vec3(sum / static_cast<double>(packets * lanes));
}

PathOptions lambertian(int paths) {
    PathOptions options;
    options.paths = paths;
    options.lambertian = true;
    return options;
}

TEST(PathTracing, FurnaceIsWhite) {
    struct Case {
        float albedo;
        int paths, sure_bounces;
        float tolerance;
    };
    // Without roulette each path sums up to 1 - albedo^bounces; with it, three times the noise is allowed.
    for (Case const& c : {Case{0, 1024, 4, 1e-3f}, Case{0.2f, 8192, 4, 1e-3f}, Case{0.5f, 131072, 4, 1e-3f},
                          Case{0.9f, 131072, 4, 5e-3f}, Case{0.9f, 8192, 100, 1e-3f}}) {
        Scene const scene = cube(glowing(Vec3(c.albedo), Vec3(1 - c.albedo)));
        RenderScene const ready(scene, black());
        PathScene const paths(ready.prepared());
        for (LightRays const light_rays : {LightRays::both, LightRays::by_surface}) {
            PathOptions options = lambertian(c.paths);
            options.light_rays = light_rays;
            options.sure_bounces = c.sure_bounces;
            Vec3 const seen = look(paths, {0.3f, 0.6f, 0.4f}, glm::normalize(Vec3(0.3f, -1, 0.2f)), options);
            EXPECT_NEAR(seen.g, 1, c.tolerance) << c.albedo << " " << static_cast<int>(light_rays);
        }
    }
}

TEST(PathTracing, WhiteSurfacesInAWhiteFurnaceAreWhite) {
    for (float const metallic : {0.0f, 1.0f}) {
        for (float const roughness : {0.0f, 0.2f, 0.5f, 1.0f}) {
            Scene scene;
            Material white = matte(Vec3(1));
            white.metallic = metallic;
            white.roughness = roughness;
            scene.materials.push_back(white);
            add(scene, quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, 0));
            RenderScene const ready(scene, Environment::uniform(Vec3(1)));
            PathScene const paths(ready.prepared());
            for (Vec3 const& to : {Vec3(0, -1, 0), Vec3(1, -1, 0), Vec3(1, -0.3f, 0)}) {
                PathOptions options;
                options.paths = 16384;
                Vec3 const seen = look(paths, -to, glm::normalize(to), options);
                EXPECT_NEAR(seen.g, 1, 0.01f) << metallic << " " << roughness << " " << to.y;
            }
        }
    }
}

Scene floor_of(float albedo) {
    Scene scene;
    scene.materials.push_back(matte(Vec3(albedo)));
    add(scene, quad({-50, 0, 50}, {100, 0, 0}, {0, 0, -100}, 0));
    return scene;
}

TEST(PathTracing, SphericalLampLightsAPlaneByItsFormFactor) {
    for (float const radius : {0.0f, 0.2f, 0.8f}) {
        Scene scene = floor_of(0.5f);
        Light lamp;
        lamp.intensity = 7;
        add_light(scene, lamp, {0, 1, 0}, {0, -1, 0});
        RenderScene const ready(scene, black());
        PathScene const paths(ready.prepared());
        PathOptions options = lambertian(16384);
        options.sizes.lamp = radius;
        for (float const x : {0.0f, 0.2f, 0.6f}) { // so near that all of the sphere is above the horizon
            float const squared = 1 + x * x;
            float const expected = 0.5f / pi * 7 / (squared * std::sqrt(squared));
            EXPECT_NEAR(look(paths, {x, 0.05f, 0}, {0, -1, 0}, options).g, expected, 2e-3f * expected) << radius;
        }
    }
}

TEST(PathTracing, InsideALampIsAsBrightAsItsSurface) {
    Scene scene = floor_of(0.5f);
    Light lamp;
    lamp.intensity = 7;
    add_light(scene, lamp, {0, 0.1f, 0}, {0, -1, 0});
    RenderScene const ready(scene, black());
    PathScene const paths(ready.prepared());
    PathOptions options = lambertian(256);
    options.sizes.lamp = 0.5f;
    float const expected = 0.5f / pi * 7 / (0.5f * 0.5f);
    EXPECT_NEAR(look(paths, {0, 0.05f, 0}, {0, -1, 0}, options).g, expected, 1e-3f * expected);
}

TEST(PathTracing, GlowingSphereLightsAPlaneByItsFormFactor) {
    Scene scene = floor_of(0.5f);
    scene.materials.push_back(glowing(Vec3(0), Vec3(3)));
    // Its own space is turned, mirrored and scaled: the light must follow it.
    Transform placed;
    placed.translation = {0, 1, 0};
    placed.rotation = glm::angleAxis(0.7f, glm::normalize(Vec3(1, 2, 3)));
    placed.scale = {-0.5f, 0.5f, 0.5f};
    add(scene, sphere(Vec3(0), 0.6f, 1, 96), placed);
    RenderScene const ready(scene, black());
    PathScene const paths(ready.prepared());
    for (float const x : {0.0f, 0.5f, 1.0f}) {
        float const squared = 1 + x * x;
        float const expected = 0.5f * 3 * 0.3f * 0.3f / (squared * std::sqrt(squared));
        EXPECT_NEAR(look(paths, {x, 0.05f, 0}, {0, -1, 0}, lambertian(65536)).g, expected, 4e-3f * expected) << x;
    }
}

/// A disc about the Y axis; `up`: seen from above, else from below.
Primitive disc(float radius, float height, bool up, Index material) {
    constexpr std::uint32_t corners = 360;
    Primitive p;
    p.positions.push_back({0, height, 0});
    for (std::uint32_t i = 0; i < corners; ++i) {
        float const phi = 2 * pi * static_cast<float>(i) / corners;
        p.positions.push_back({radius * std::sin(phi), height, radius * std::cos(phi)});
        std::uint32_t const next = (i + 1) % corners + 1;
        p.triangles.push_back(up ? std::array{0u, i + 1, next} : std::array{0u, next, i + 1});
    }
    p.normals.assign(p.positions.size(), Vec3(0, up ? 1.0f : -1.0f, 0));
    p.material = material;
    return p;
}

TEST(PathTracing, ParallelDiscsExchangeTheirFormFactor) {
    constexpr float from_radius = 0.7f, to_radius = 1.2f; // a metre apart
    Scene scene;
    scene.materials = {matte(Vec3(0.6f)), glowing(Vec3(0), Vec3(2))};
    add(scene, disc(from_radius, 0, true, 0));
    add(scene, disc(to_radius, 1, false, 1));
    RenderScene const ready(scene, black());
    PathScene const paths(ready.prepared());
    double sum = 0;
    constexpr std::uint32_t points = 512;
    for (std::uint32_t i = 0; i < points; ++i) {
        Vec2 const random = random_pair(5, i, 0);
        float const r = from_radius * std::sqrt(random.x) * 0.9999f;
        Vec3 const at(r * std::sin(2 * pi * random.y), 0.01f, r * std::cos(2 * pi * random.y));
        sum += double(look(paths, at, {0, -1, 0}, lambertian(256)).g);
    }
    double const ratio = double(to_radius) / double(from_radius);
    double const x = 1 + (1 + double(to_radius) * double(to_radius)) / (double(from_radius) * double(from_radius));
    double const form_factor = 0.5 * (x - std::sqrt(x * x - 4 * ratio * ratio));
    EXPECT_NEAR(sum / points, 0.6 * 2 * form_factor, 0.002 * 0.6 * 2 * form_factor);
}

TEST(PathTracing, GreyBoxAgreesWithRadiosity) {
    GreyBox const box;
    RenderScene const ready(box.scene, black());
    PathScene const paths(ready.prepared());
    for (GreyBox::Point const& p : GreyBox::points) {
        Wall const wall = cube_walls()[static_cast<std::size_t>(p.wall)];
        Vec3 const at = wall.at(p.u, p.v);
        double const expected = box.radiance(p);
        double const seen = double(look(paths, at + wall.normal() * 0.1f, -wall.normal(), lambertian(65536)).g);
        EXPECT_NEAR(seen, expected, 0.006 * expected) << p.wall << " " << p.u << " " << p.v;
    }
}

TEST(PathTracing, PenumbraIsAsWideAsTheSun) {
    constexpr float radius = 0.03f, height = 2;
    Scene scene = floor_of(0.5f);
    add(scene, quad({-50, height, 50}, {50, 0, 0}, {0, 0, -100}, 0)); // its edge is above x = 0
    Light sun;
    sun.type = LightType::directional;
    sun.intensity = 2;
    add_light(scene, sun, {0, 9, 0}, {0, -1, 0});
    RenderScene const ready(scene, black());
    PathScene const paths(ready.prepared());
    PathOptions options = lambertian(16384);
    options.sizes.sun = radius;
    for (float const s : {-1.02f, -0.9f, -0.5f, 0.0f, 0.5f, 0.9f, 1.02f}) {
        float const inside = std::clamp(s, -1.0f, 1.0f);
        float const visible = 0.5f + (inside * std::sqrt(1 - inside * inside) + std::asin(inside)) / pi;
        float const x = s * height * std::tan(radius); // half the width of 2 height tan(radius) is s = 1
        // From below the sheet, so that light that it reflects is no part of it: the floor's own light alone bounces.
        float const seen = look(paths, {x, 0.01f, 0}, {0, -1, 0}, options).g;
        EXPECT_NEAR(seen / (0.5f / pi * 2), visible, 0.006f) << s;
    }
}

TEST(PathTracing, HardLampsLightAsDirectShadingHasThem) {
    for (auto const& [metallic, roughness] : {std::pair{0.0f, 0.4f}, std::pair{1.0f, 0.4f}, std::pair{1.0f, 1.0f}}) {
        Scene scene = floor_of(0.7f);
        scene.materials[0].metallic = metallic;
        scene.materials[0].roughness = roughness;
        Light lamp;
        lamp.intensity = 7;
        add_light(scene, lamp, {0, 2, 0}, {0, -1, 0});
        Light spot;
        spot.type = LightType::spot;
        spot.intensity = 9;
        spot.outer_cone = 0.6f;
        add_light(scene, spot, {1, 2, 0}, {-0.3f, -1, 0});
        RenderScene const ready(scene, black());
        PathScene const paths(ready.prepared());
        PathOptions options;
        options.paths = 4096;
        for (float const x : {-0.5f, 0.1f, 0.8f}) {
            Vec3 const from = Vec3(x, 1.5f, 0.4f), to = glm::normalize(Vec3(0, -1, -0.3f));
            Vec3 const direct = look_along(ready, from, to).radiance;
            EXPECT_NEAR(look(paths, from, to, options).g, direct.g, 0.015f * direct.g) << metallic << roughness << x;
        }
    }
}

TEST(PathTracing, RoughMetalsReflectTheSkyAsDirectShadingHasThem) {
    FloatImage sky(64, 32);
    for (int y = 0; y < sky.height; ++y) {
        std::fill_n(&sky.at(0, y), sky.width, y < sky.height / 2 ? Vec3(1) : Vec3(0));
    }
    for (float const roughness : {0.5f, 0.7f, 1.0f}) {
        Scene scene = floor_of(0.7f);
        scene.materials[0].metallic = 1;
        scene.materials[0].roughness = roughness;
        RenderScene const ready(scene, Environment(sky));
        PathScene const paths(ready.prepared());
        PathOptions options;
        options.paths = 16384;
        for (float const rise : {1.0f, 0.5f, 0.2f}) {
            Vec3 const from(0, 1, 0), to = glm::normalize(Vec3(0, -rise, -1));
            Vec3 const direct = look_along(ready, from, to).radiance;
            float const seen = look(paths, from, to, options).g;
            EXPECT_NEAR(direct.g, seen, 0.06f * seen) << roughness << " " << rise;
        }
    }
}

/// Mean of several seeds and the standard error of that mean.
struct Estimate {
    double mean, error;
};
Estimate estimate(PathScene const& paths, Vec3 origin, Vec3 direction, PathOptions options) {
    constexpr int seeds = 8;
    double sum = 0, squares = 0;
    for (int seed = 0; seed < seeds; ++seed) {
        options.seed = static_cast<std::uint32_t>(seed);
        double const seen = double(look(paths, origin, direction, options).g);
        sum += seen;
        squares += seen * seen;
    }
    double const mean = sum / seeds;
    return {mean, std::sqrt(std::max(squares / seeds - mean * mean, 0.0) / (seeds - 1))};
}

/// A room that is open at the front, with a lamp, a spot, a glowing square and a sky with a bright spot.
Scene room(float metallic, float roughness) {
    Scene scene;
    Material walls = matte(Vec3(0.7f));
    walls.metallic = metallic;
    walls.roughness = roughness;
    scene.materials = {walls, glowing(Vec3(0.5f), Vec3(5))};
    std::array<Wall, 6> const all = cube_walls();
    for (std::size_t w = 0; w < 5; ++w) {
        add(scene, quad(all[w].corner, all[w].side_u, all[w].side_v, 0));
    }
    add(scene, quad({0.2f, 0.8f, 0.3f}, {0.2f, 0, 0}, {0, 0.1f, 0.2f}, 1));
    Light lamp;
    lamp.intensity = 0.3f;
    add_light(scene, lamp, {0.7f, 0.5f, 0.5f}, {0, -1, 0});
    Light spot;
    spot.type = LightType::spot;
    spot.intensity = 0.2f;
    spot.outer_cone = 0.6f;
    add_light(scene, spot, {0.3f, 0.6f, 0.6f}, {-0.3f, -1, -0.2f});
    return scene;
}

Environment spotted_sky() {
    FloatImage sky(64, 32);
    for (int y = 0; y < sky.height; ++y) {
        for (int x = 0; x < sky.width; ++x) {
            sky.at(x, y) = x < 6 && y >= 8 && y < 12 ? Vec3(6) : Vec3(0.2f);
        }
    }
    return Environment(sky);
}

TEST(PathTracing, LightIsTheSameHoweverItIsFound) {
    struct Case {
        float roughness, lamp_radius;
    };
    for (auto const& [roughness, lamp_radius] : {Case{0.35f, 0.1f}, Case{1, 0.1f}, Case{1, 0}}) {
        Scene const scene = room(roughness < 1 ? 1.0f : 0.0f, roughness);
        RenderScene const ready(scene, spotted_sky());
        PathScene const paths(ready.prepared());
        PathOptions options;
        options.paths = 4096;
        options.sizes.lamp = lamp_radius;
        for (Vec3 const& to : {Vec3(-0.2f, -0.5f, -1), Vec3(0.3f, -1, -0.4f)}) {
            auto const estimate_by = [&](LightRays by) {
                options.light_rays = by;
                return estimate(paths, {0.5f, 0.6f, 0.95f}, glm::normalize(to), options);
            };
            Estimate const both = estimate_by(LightRays::both);
            for (LightRays const by : {LightRays::to_lights, LightRays::by_surface}) {
                Estimate const one = estimate_by(by);
                double const allowed = 4 * std::hypot(one.error, both.error) + 1e-4 * both.mean;
                EXPECT_NEAR(one.mean, both.mean, allowed) << roughness << " " << static_cast<int>(by);
                EXPECT_LT(allowed, 0.08 * both.mean) << "too noisy to tell: " << static_cast<int>(by);
            }
            EXPECT_LT(both.error, 0.01 * both.mean);
        }
    }
}

/// A closed room whose lamp is so near to a small plate that half of its light falls there first.
struct RoomWithLitPlate {
    static constexpr float albedo = 0.5f, candela = 3;
    std::vector<Wall> sides; ///< of all surfaces; their normals are where they are seen from
    Scene scene = cube(matte(Vec3(albedo)));

    RoomWithLitPlate() {
        scene.materials[0].double_sided = true;
        Wall const plate{{0.4f, 0.7f, 0.45f}, {0, 0, 0.1f}, {0.1f, 0, 0}};
        add(scene, quad(plate.corner, plate.side_u, plate.side_v, 0));
        for (Wall const& wall : cube_walls()) {
            sides.push_back(wall);
        }
        sides.push_back(plate);
        sides.push_back({plate.corner, plate.side_v, plate.side_u});
        Light lamp;
        lamp.intensity = candela;
        add_light(scene, lamp, {0.44f, 0.71f, 0.5f}, {0, -1, 0});
    }
};

TEST(PathTracing, BouncesFindWhatLampsLightFromNear) {
    RoomWithLitPlate const room;
    RenderScene const ready(room.scene, black());
    PathScene const paths(ready.prepared());
    for (float const size : {0.0f, 0.01f}) {
        PathOptions options = lambertian(1024);
        options.sizes.lamp = size;
        Estimate const wall = estimate(paths, {0.5f, 0.5f, 0.5f}, {1, 0.2f, 0.1f}, options);
        EXPECT_LT(wall.error * std::sqrt(8.0), 0.05 * wall.mean) << size; // of each estimate
    }
}

TEST(PathTracing, ClosedRoomKeepsTheLightOfItsLamp) {
    RoomWithLitPlate const room;
    RenderScene const ready(room.scene, black());
    PathScene const paths(ready.prepared());
    for (float const size : {0.0f, 0.01f}) {
        double reflected = 0; // lumen
        for (Wall const& side : room.sides) {
            double const area = double(glm::length(side.normal()));
            constexpr std::uint32_t points = 1024;
            for (std::uint32_t i = 0; i < points; ++i) {
                Vec2 const random = random_pair(9, i, 0);
                Vec3 const normal = glm::normalize(side.normal());
                PathOptions options = lambertian(16);
                options.sizes.lamp = size;
                options.seed = i;
                Vec3 const from = side.at(random.x, random.y) + normal * 1e-3f;
                reflected += double(look(paths, from, -normal, options).g) * double(pi) * area / points;
            }
        }
        // All surfaces together reflect this share of what the lamp sends, and of what they reflect themselves.
        double const expected = double(4 * pi * room.candela * room.albedo / (1 - room.albedo));
        EXPECT_NEAR(reflected, expected, 0.01 * expected) << size;
    }
}

TEST(PathTracing, BacksHideLightHoweverItIsFound) {
    Scene scene = floor_of(0.5f);
    add(scene, quad({-50, 1, 50}, {100, 0, 0}, {0, 0, -100}, 0)); // a camera below sees through it
    scene.materials.push_back(glowing(Vec3(0), Vec3(3)));
    add(scene, quad({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, 1));
    RenderScene const ready(scene, Environment::uniform(Vec3(1)));
    PathScene const paths(ready.prepared());
    PathOptions options = lambertian(16384);
    for (LightRays const by : {LightRays::both, LightRays::to_lights, LightRays::by_surface}) {
        options.light_rays = by;
        EXPECT_LT(look(paths, {0, 0.5f, 0}, {0, -1, 0}, options).g, 0.02f) << static_cast<int>(by); // from its edge
    }
}

TEST(PathTracing, NothingReflectsMoreThanItGets) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> share(-0.4f, 1.4f); // often an end of the range
    auto const any = [&] { return std::clamp(share(random), 0.0f, 1.0f); };
    Scene scene;
    for (Index i = 0; i < 40; ++i) {
        Material m;
        m.base_color = Vec4(any(), any(), any(), any());
        m.metallic = any();
        m.roughness = any();
        m.transmission = i % 3 == 0 ? any() : 0.0f;
        m.alpha_mode = i % 4 == 0 ? AlphaMode::blend : i % 4 == 1 ? AlphaMode::mask : AlphaMode::opaque;
        m.double_sided = i % 2 == 0;
        scene.materials.push_back(m);
        Vec3 const center(4 * any() - 2, 4 * any() - 2, 4 * any() - 2);
        Primitive p = sphere(center, 0.2f + 0.6f * any(), i, 6);
        p.positions[20] = p.positions[21]; // triangles without an area
        p.normals[30] = Vec3(0);
        add(scene, p);
    }
    RenderScene const ready(scene, Environment::uniform(Vec3(1)));
    FloatImage const seen =
        render_paths(ready, look_at({0, 1, 6}, {0, 0, 0}, {0, 1, 0}, 0.8f), {48, 36}, {.paths = 64});
    for (Vec3 const& pixel : seen.rgb) {
        for (int c = 0; c < 3; ++c) {
            EXPECT_TRUE(std::isfinite(pixel[c]) && pixel[c] >= 0);
            EXPECT_LT(pixel[c], 1.25f); // estimates of 64 paths
        }
    }
    Vec3 sum(0);
    for (Vec3 const& pixel : seen.rgb) {
        sum += pixel / static_cast<float>(seen.rgb.size());
    }
    EXPECT_LT(std::max({sum.r, sum.g, sum.b}), 1.0f);
}

TEST(PathTracing, LampsOfARoomDoNotPassItsWalls) {
    Scene scene = cube(matte(Vec3(0.8f)));
    scene.materials.push_back(glowing(Vec3(0.5f), Vec3(50)));
    add(scene, quad({-1, 3, 1}, {3, 0, 0}, {0, 0, 3}, 1));
    Light lamp;
    lamp.intensity = 100;
    add_light(scene, lamp, {0.5f, 2, 0.5f}, {0, -1, 0});
    for (Material& material : scene.materials) {
        material.double_sided = true;
    }
    RenderScene const ready(scene, Environment::uniform(Vec3(10)));
    Camera const inside = look_at({0.5f, 0.5f, 0.9f}, {0.4f, 0.3f, 0}, {0, 1, 0}, 1.2f);
    for (Vec3 const& pixel : render_paths(ready, inside, {32, 24}, {.paths = 16}).rgb) {
        EXPECT_EQ(pixel, Vec3(0));
    }
}

TEST(PathTracing, SameSeedSamePicture) {
    Scene const scene = room(0, 0.5f);
    RenderScene const ready(scene, spotted_sky());
    Camera const camera = look_at({0.5f, 0.5f, 2}, {0.5f, 0.5f, 0}, {0, 1, 0}, 0.8f);
    PathOptions options;
    options.paths = 4;
    FloatImage const once = render_paths(ready, camera, {24, 16}, options);
    EXPECT_EQ(once.rgb, render_paths(ready, camera, {24, 16}, options).rgb);
    options.seed = 1;
    EXPECT_NE(once.rgb, render_paths(ready, camera, {24, 16}, options).rgb);
}

} // namespace
} // namespace framelet
