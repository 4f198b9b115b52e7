#include "server/render/framelet_renderer.h"

#include <algorithm>
#include <cstring>
#include <random>

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "common/color.h"
#include "scene_builder.h"
#include "server/render/display_framelet.h"

namespace framelet {
namespace {

using namespace test;

std::vector<Tile> all_tiles(ImagePlane const& plane, int depth) {
    std::vector<Tile> tiles;
    for (std::uint32_t code = 1u << (2 * depth); code < 2u << (2 * depth); ++code) {
        if (plane.is_visible({code})) {
            tiles.push_back({code});
        }
    }
    return tiles;
}

/// One of everything: mirror, mask, blend, textures, point and directional light.
Scene varied_scene() {
    Scene scene;
    Material mirror = matte({0.9f, 0.8f, 0.7f}), leaf = matte({0.2f, 0.8f, 0.2f}), pane = matte({0.3f, 0.4f, 0.9f});
    mirror.metallic = 1;
    mirror.roughness = 0.05f;
    leaf.alpha_mode = AlphaMode::mask;
    leaf.double_sided = true;
    leaf.base_color_texture.texture = add_texture(scene, 16, 16, [](int x, int y) {
        bool const hole = (x / 3 + y / 3) % 2 != 0;
        return std::array<std::uint8_t, 4>{255, static_cast<std::uint8_t>(16 * x), 255,
                                           static_cast<std::uint8_t>(hole ? 0 : 255)};
    });
    pane.alpha_mode = AlphaMode::blend;
    pane.base_color.a = 0.4f;
    pane.roughness = 0.1f;
    scene.materials = {matte(Vec3(0.6f)), mirror, leaf, pane};
    add(scene, quad({-8, -1, 8}, {16, 0, 0}, {0, 0, -16}, 0));
    add(scene, sphere({-1.2f, 0, 0}, 1, 1));
    add(scene, sphere({1.2f, 0, -1}, 1, 2));
    add(scene, quad({-2, -1, 1.5f}, {4, 0, 0}, {0, 1.5f, 0}, 3));
    Light sun, lamp;
    sun.type = LightType::directional;
    sun.intensity = 2;
    lamp.intensity = 8;
    lamp.range = 9;
    add_light(scene, sun, {0, 5, 0}, {-0.4f, -1, -0.3f});
    add_light(scene, lamp, {0, 2, 2}, {0, -1, 0});
    return scene;
}

Camera const view = look_at({0.5f, 1.2f, 6}, {0, 0, 0}, {0, 1, 0}, 0.8f);

bool same(Framelet const& a, Framelet const& b) {
    return a.tile == b.tile && a.red == b.red && a.green == b.green && a.blue == b.blue &&
           std::memcmp(a.depth.data(), b.depth.data(), sizeof(a.depth)) == 0;
}

TEST(FrameletRenderer, ResultDependsOnNeitherThreadsNorOrder) {
    Scene const scene = varied_scene();
    RenderScene const ready(scene, Environment::default_sky());
    ImagePlane const plane({96, 64});
    std::vector<Tile> tiles = all_tiles(plane, plane.pixel_depth());
    std::vector<Framelet> one(tiles.size()), two(tiles.size()), backwards(tiles.size());
    tbb::task_arena(1).execute([&] { render_framelets(ready, view, plane, tiles, one); });
    tbb::task_arena(2).execute([&] { render_framelets(ready, view, plane, tiles, two); });
    std::ranges::reverse(tiles);
    render_framelets(ready, view, plane, tiles, backwards);
    for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_TRUE(same(one[i], two[i])) << one[i].tile.code;
        EXPECT_TRUE(same(one[i], backwards[one.size() - 1 - i])) << one[i].tile.code;
    }
}

TEST(FrameletRenderer, SamplesAtItsPlacesAreThoseOfTheFramelet) {
    Scene const scene = varied_scene();
    RenderScene const ready(scene, Environment::default_sky());
    ImagePlane const plane({48, 40});
    ViewRays const rays = make_view_rays(view, plane.viewport());
    Tile const tile = make_tile(plane.pixel_depth(), 1, 1);
    Framelet framelet;
    std::uint32_t const segments = render_framelet(ready, rays, plane, tile, framelet);
    EXPECT_GE(segments, 256u);
    std::vector<Vec2> positions;
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        positions.emplace_back(16.5f + static_cast<float>(morton_x(i)), 16.5f + static_cast<float>(morton_y(i)));
    }
    std::vector<float> const spacings(positions.size(), 1.0f);
    std::vector<Vec3> radiance(positions.size());
    EXPECT_EQ(render_samples(ready, rays, positions, spacings, radiance), segments);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        EXPECT_EQ(radiance[i], Vec3(framelet.red[i], framelet.green[i], framelet.blue[i])) << i;
    }
    std::vector<Vec3> few(5);
    render_samples(ready, rays, std::span(positions).first(5), std::span(spacings).first(5), few);
    EXPECT_TRUE(std::equal(few.begin(), few.end(), radiance.begin()));
}

TEST(FrameletRenderer, DepthIsViewDepthAndInfiniteInTheSky) {
    Scene scene;
    scene.materials = {matte(Vec3(0.5f))};
    add(scene, quad({-50, -50, -4}, {60, 0, 0}, {0, 100, 0}, 0)); // left part of the view
    RenderScene const ready(scene, black());
    Camera camera;
    camera.vertical_extent = 1.2f;
    ImagePlane const plane({64, 64});
    std::vector<Tile> const tiles = all_tiles(plane, plane.pixel_depth());
    std::vector<Framelet> out(tiles.size());
    render_framelets(ready, camera, plane, tiles, out);
    for (Framelet const& f : out) {
        for (float const depth : f.depth) {
            EXPECT_NEAR(depth, 4, 1e-4f);
        }
    }
    camera.orientation = look_at({0, 0, 0}, {5, 0, -1}, {0, 1, 0}, 1).orientation;
    render_framelets(ready, camera, plane, tiles, out);
    int sky = 0, slanted = 0;
    ViewRays const rays = make_view_rays(camera, plane.viewport());
    for (Framelet const& f : out) {
        PixelRect const rect = plane.tile_rect(f.tile);
        for (std::uint32_t i = 0; i < framelet_samples; ++i) {
            float const x = static_cast<float>(rect.left) + static_cast<float>(morton_x(i)) + 0.5f;
            float const y = static_cast<float>(rect.top) + static_cast<float>(morton_y(i)) + 0.5f;
            Vec3 const direction = rays.direction + rays.direction_dx * x + rays.direction_dy * y;
            if (std::isinf(f.depth[i])) {
                ++sky;
            } else {
                EXPECT_NEAR(direction.z * f.depth[i], -4, 2e-3f);
                ++slanted;
            }
        }
    }
    EXPECT_GT(sky, 100);
    EXPECT_GT(slanted, 100);
}

TEST(FrameletRenderer, FineAndCoarseTilesAgreeOnPlaces) {
    // A red half plane whose edge crosses the picture: samples of every depth tell the same side at the same place.
    Scene scene;
    Material red = matte({1, 0, 0});
    red.unlit = true;
    scene.materials = {red};
    add(scene, quad({-50, -50, -4}, {50.3f, 0, 0}, {0, 100, 0}, 0));
    RenderScene const ready(scene, black());
    Camera const camera;
    ImagePlane const plane({128, 128});
    ViewRays const rays = make_view_rays(camera, plane.viewport());
    for (int depth = plane.min_depth(); depth <= plane.max_depth(); ++depth) {
        for (Tile const tile : all_tiles(plane, depth)) {
            Framelet out;
            render_framelet(ready, rays, plane, tile, out);
            for (std::uint32_t i = 0; i < framelet_samples; ++i) {
                float const x = static_cast<float>(plane.tile_rect(tile).left) +
                                (static_cast<float>(morton_x(i)) + 0.5f) * plane.sample_spacing(tile);
                float const at = (rays.direction + rays.direction_dx * x).x * 4;
                if (std::abs(at - 0.3f) > 1e-3f) {
                    ASSERT_EQ(out.red[i], at < 0.3f ? 1.0f : 0.0f) << tile.code << ' ' << i;
                }
            }
        }
    }
}

TEST(FrameletRenderer, SamplesLieInTheMiddleOfTheirSquares) {
    // Ramps: red tells the position along x, green along y.
    Scene scene;
    Material ramp = matte(Vec3(1));
    ramp.unlit = true;
    scene.materials = {ramp};
    Primitive p = quad({-8, -8, -1}, {16, 0, 0}, {0, 16, 0}, 0);
    p.colors = {{0, 0, 0, 1}, {1, 0, 0, 1}, {1, 1, 0, 1}, {0, 1, 0, 1}};
    add(scene, p);
    RenderScene const ready(scene, black());
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.vertical_extent = 16;
    ImagePlane const plane({16, 16});
    ViewRays const rays = make_view_rays(camera, plane.viewport());
    Framelet framelet;
    render_framelet(ready, rays, plane, {1}, framelet);
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        EXPECT_NEAR(framelet.red[i] * 16, static_cast<float>(morton_x(i)) + 0.5f, 1e-3f);
        EXPECT_NEAR((1 - framelet.green[i]) * 16, static_cast<float>(morton_y(i)) + 0.5f, 1e-3f);
    }
}

TEST(FrameletRenderer, PictureIsTheBoxFilteredGridOfFramelets) {
    Scene const scene = varied_scene();
    RenderScene const ready(scene, Environment::default_sky());
    Viewport const viewport{40, 24};
    ImagePlane const plane(viewport);
    Picture const single = render_picture(ready, view, viewport, 1.5f, 1);
    Picture const twice = render_picture(ready, view, viewport, 1.5f, 2);
    ViewRays const rays = make_view_rays(view, viewport);
    Framelet framelet;
    render_framelet(ready, rays, plane, make_tile(plane.pixel_depth(), 1, 0), framelet);
    DisplayFramelet const shown = to_display(framelet, 1.5f);
    EXPECT_EQ(single.row(5)[(16 + 9) * 4 + 1], shown.green[morton_index(9, 5)]);
    render_framelet(ready, rays, plane, make_tile(plane.pixel_depth() + 1, 3, 1), framelet);
    DisplayFramelet const fine = to_display(framelet, 1.5f);
    float sum = 0;
    for (std::uint32_t i = 0; i < 4; ++i) {
        sum += linear_from_srgb_byte(fine.green[morton_index(2 * 2 + i % 2, 2 * 3 + i / 2)]) / 4;
    }
    EXPECT_EQ(twice.row(8 + 3)[(24 + 2) * 4 + 1], srgb_byte_from_linear(sum));
    EXPECT_EQ(twice.row(0)[3], 255);
}

TEST(FrameletRenderer, FarCheckerboardIsGrey) {
    Scene scene;
    Material board = matte(Vec3(1));
    board.unlit = true;
    board.base_color_texture.texture = add_texture(scene, 64, 64, [](int x, int y) {
        std::uint8_t const v = (x + y) % 2 ? 255 : 0;
        return std::array<std::uint8_t, 4>{v, v, v, 255};
    });
    scene.materials = {board};
    Primitive p = quad({-500, -1, 500}, {1000, 0, 0}, {0, 0, -1000}, 0);
    for (Vec2& uv : p.uv[0]) {
        uv *= 100;
    }
    add(scene, p);
    RenderScene const ready(scene, black());
    ImagePlane const plane({64, 64});
    Camera const camera = look_at({0, 60, 100}, {0, 0, 0}, {0, 1, 0}, 0.8f);
    for (Tile const tile : all_tiles(plane, plane.pixel_depth())) {
        Framelet out;
        render_framelet(ready, make_view_rays(camera, plane.viewport()), plane, tile, out);
        for (float const red : out.red) {
            EXPECT_NEAR(red, 0.5f, 0.03f);
        }
    }
}

/// Triangles, normals, coordinates and transforms of the worst kind that a consistent scene can hold.
Scene degenerate_scene(unsigned seed) {
    std::mt19937 random(seed);
    auto uniform = [&](float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); };
    auto awkward = [&]() -> float {
        float const choices[] = {0,
                                 1,
                                 -1,
                                 1e-20f,
                                 1e-8f,
                                 1e4f,
                                 -1e6f,
                                 1e15f,
                                 uniform(-2, 2),
                                 uniform(-2, 2),
                                 uniform(-2, 2),
                                 uniform(-2, 2),
                                 uniform(-2, 2),
                                 uniform(-2, 2)};
        return choices[random() % std::size(choices)];
    };
    auto vector = [&] { return Vec3(awkward(), awkward(), awkward()); };
    Scene scene;
    Index const texture = add_texture(scene, 5, 3, [&](int, int) {
        return std::array<std::uint8_t, 4>{static_cast<std::uint8_t>(random()), static_cast<std::uint8_t>(random()),
                                           static_cast<std::uint8_t>(random()), static_cast<std::uint8_t>(random())};
    });
    for (int i = 0; i < 6; ++i) {
        Material m;
        m.base_color = {uniform(0, 1), uniform(0, 1), uniform(0, 1), uniform(0, 1)};
        m.metallic = static_cast<float>(random() % 3) / 2;
        m.roughness = static_cast<float>(random() % 5) / 4;
        m.transmission = random() % 4 == 0 ? 1.0f : 0.0f;
        m.alpha_mode = static_cast<AlphaMode>(random() % 3);
        m.double_sided = random() % 2 == 0;
        m.normal_scale = awkward();
        for (TextureUse* use : {&m.base_color_texture, &m.metallic_roughness_texture, &m.normal_texture,
                                &m.occlusion_texture, &m.emissive_texture}) {
            use->texture = random() % 2 == 0 ? texture : none;
            use->scale = {awkward(), awkward()};
            use->rotation = awkward();
        }
        m.emissive = Vec3(uniform(0, 2));
        scene.materials.push_back(m);
    }
    for (int i = 0; i < 12; ++i) {
        Primitive p;
        p.material = static_cast<Index>(random() % 6);
        for (int v = 0; v < 30; ++v) {
            p.positions.push_back(vector());
            p.normals.push_back(random() % 3 == 0 ? Vec3(0) : vector());
            p.tangents.push_back(Vec4(random() % 3 == 0 ? Vec3(0) : vector(), random() % 2 ? 1.0f : -1.0f));
            p.uv[0].emplace_back(awkward(), awkward());
        }
        if (random() % 2 == 0) {
            p.tangents.clear();
        }
        for (int t = 0; t < 40; ++t) {
            p.triangles.push_back({static_cast<std::uint32_t>(random() % 30), static_cast<std::uint32_t>(random() % 30),
                                   static_cast<std::uint32_t>(random() % 30)});
        }
        Transform transform;
        transform.scale = random() % 2 == 0 ? Vec3(1) : vector();
        add(scene, p, transform);
    }
    for (int i = 0; i < 4; ++i) {
        Light light;
        light.type = static_cast<LightType>(random() % 3);
        light.intensity = random() % 3 == 0 ? 1e30f : uniform(0, 10);
        light.range = random() % 2 == 0 ? 0.0f : awkward();
        light.inner_cone = light.outer_cone = uniform(0, 1);
        add_light(scene, light, random() % 2 == 0 ? Vec3(0) : vector(), {0, -1, 0.3f});
    }
    return scene;
}

TEST(FrameletRenderer, DegenerateScenesYieldFiniteLight) {
    for (unsigned seed = 0; seed < 60; ++seed) {
        Scene const scene = degenerate_scene(seed);
        RenderScene const ready(scene, seed % 2 ? std::optional(Environment::uniform(Vec3(1))) : std::nullopt);
        ImagePlane const plane({32, 32});
        std::vector<Tile> const tiles = all_tiles(plane, plane.pixel_depth());
        std::vector<Framelet> out(tiles.size());
        render_framelets(ready, look_at({0.3f, 0.7f, 4}, {0, 0, 0}, {0, 1, 0}, 0.9f), plane, tiles, out);
        for (Framelet const& f : out) {
            for (std::size_t i = 0; i < framelet_samples; ++i) {
                for (float const v : {f.red[i], f.green[i], f.blue[i]}) {
                    ASSERT_TRUE(std::isfinite(v) && v >= 0)
                        << v << " seed " << seed << " tile " << f.tile.code << ' ' << i;
                }
                ASSERT_TRUE(f.depth[i] > 0) << "seed " << seed << " tile " << f.tile.code << ' ' << i;
            }
        }
    }
}

} // namespace
} // namespace framelet
