#include "server/render/display_renderer.h"

#include <gtest/gtest.h>

#include "common/color.h"
#include "scene_builder.h"
#include "server/render/display_framelet.h"

namespace framelet {
namespace {

using namespace test;

constexpr Tile parent = make_tile(3, 5, 2);

/// A child of `parent` whose radiance is a function of its samples' places in it, [0, 2)^2 over the parent's children.
template <class Radiance>
Framelet make_child(std::uint32_t quadrant, Radiance&& radiance) {
    Framelet child;
    child.tile = parent.child(quadrant);
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        float const x = static_cast<float>(quadrant % 2) + (static_cast<float>(morton_x(i)) + 0.5f) / framelet_side;
        float const y = static_cast<float>(quadrant / 2) + (static_cast<float>(morton_y(i)) + 0.5f) / framelet_side;
        child.red[i] = child.green[i] = child.blue[i] = radiance(x, y);
        child.depth[i] = 1 + x + 10 * y;
    }
    return child;
}

template <class Radiance>
void merge_children(Radiance&& radiance, Framelet& geometry, DisplayFramelet& display) {
    geometry.tile = display.tile = parent;
    for (std::uint32_t quadrant = 0; quadrant < 4; ++quadrant) {
        merge_child(make_child(quadrant, radiance), 2, false, geometry, display);
    }
}

TEST(MergeChild, WhatIsTheSameEverywhereStaysThat) {
    for (float const value : {0.0f, 0.01f, 0.2f, 0.5f, 30.0f}) {
        Framelet flat, geometry;
        flat.tile = parent;
        flat.red.fill(value);
        flat.green = flat.blue = flat.red;
        DisplayFramelet display;
        merge_children([value](float, float) { return value; }, geometry, display);
        EXPECT_EQ(display, to_display(flat, 2)) << value;
        EXPECT_TRUE(geometry.body.empty() && geometry.drift.empty() && geometry.reflects.none());
    }
}

TEST(MergeChild, AGradientIsThatOfTheCellsMiddles) {
    // Between these values the tone curve subtracts a constant.
    auto const ramp = [](float x, float y) { return 0.05f + 0.1f * x + 0.04f * y; };
    Framelet geometry;
    DisplayFramelet display;
    merge_children(ramp, geometry, display);
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        float const x = (static_cast<float>(morton_x(i)) + 0.5f) / (framelet_side / 2);
        float const y = (static_cast<float>(morton_y(i)) + 0.5f) / (framelet_side / 2);
        EXPECT_NEAR(display.red[i], srgb_byte_from_linear(2 * ramp(x, y) - 0.04f), 1) << i;
        constexpr float cell = 1.0f / framelet_side;
        EXPECT_NEAR(geometry.depth[i], 1 + x + 10 * y, 5.5f * cell) << "of a sample within its cell";
    }
}

TEST(MergeChild, WhiteAndBlackMeetInTheMiddleOfTheDisplaysLight) {
    auto const columns = [](float x, float) { return static_cast<int>(16 * x) % 2 != 0 ? 1e6f : 0; };
    Framelet geometry;
    DisplayFramelet display;
    merge_children(columns, geometry, display);
    for (std::uint8_t const value : display.green) {
        EXPECT_NEAR(value, srgb_byte_from_linear(0.5f), 1);
    }
}

TEST(MergeChild, BodiesAndMotionComeAlong) {
    Framelet geometry;
    DisplayFramelet display;
    geometry.tile = display.tile = parent;
    for (std::uint32_t quadrant = 0; quadrant < 4; ++quadrant) {
        Framelet child = make_child(quadrant, [](float, float) { return 0.5f; });
        if (quadrant == 2) { // the others are static
            child.body.assign(framelet_samples, 7);
            child.drift.assign(framelet_samples, Drift{Vec3(1, 2, 3)});
            child.reflects.set();
        }
        merge_child(child, 1, false, geometry, display);
    }
    ASSERT_EQ(geometry.body.size(), framelet_samples);
    ASSERT_EQ(geometry.drift.size(), framelet_samples);
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        bool const moves = i / 64 == 2;
        EXPECT_EQ(geometry.body[i], moves ? 7 : static_body) << i;
        EXPECT_EQ(geometry.drift[i].velocity, moves ? Vec3(1, 2, 3) : Vec3(0)) << i;
        EXPECT_EQ(geometry.reflects[i], moves) << i;
    }
}

TEST(MergeChild, TheSurfaceIsWhatMostRaysShow) {
    constexpr float far = std::numeric_limits<float>::infinity();
    // Depths and bodies of four rays; the body of the surface that is shown, and its depth: the inverse of the mean
    // inverse depth of the rays that show it.
    struct Case {
        std::array<float, 4> depth;
        std::array<BodyNumber, 4> body;
        BodyNumber shown;
        float wanted;
    };
    for (Case const& one : {Case{{5, 9, 9.1f, 9.2f}, {}, 0, 3 / (1 / 9.0f + 1 / 9.1f + 1 / 9.2f)},
                            Case{{5, 5, 5, 5}, {0, 3, 3, 3}, 3, 5}, Case{{far, far, 2, far}, {0, 0, 7, 0}, 0, far},
                            Case{{far, 2, 2.02f, far}, {0, 7, 7, 0}, 0, far}, // a tie: the first is shown
                            Case{{1, 2, 4, 8}, {}, 0, 1}}) {
        Framelet geometry;
        DisplayFramelet display;
        geometry.tile = display.tile = parent;
        Framelet child = make_child(0, [](float, float) { return 0.5f; });
        child.body.resize(framelet_samples);
        for (std::size_t i = 0; i < framelet_samples; ++i) {
            child.depth[i] = one.depth[i % 4];
            child.body[i] = one.body[i % 4];
        }
        merge_child(child, 1, false, geometry, display);
        for (std::size_t i = 0; i < framelet_samples / 4; ++i) {
            ASSERT_EQ(geometry.body[i], one.shown);
            ASSERT_NEAR(1 / geometry.depth[i], 1 / one.wanted, 1e-6f);
        }
    }
}

TEST(MergeChild, WhatNeverMovesGetsNoLightOfBodiesWhereTheyWillHaveGone) {
    for (BodyNumber const most : {static_body, BodyNumber{7}}) { // the body that three of four rays show
        for (bool const will_be_moved : {false, true}) {
            Framelet geometry;
            DisplayFramelet display;
            geometry.tile = display.tile = parent;
            Framelet child = make_child(0, [](float, float) { return 0.0f; });
            child.body.resize(framelet_samples);
            for (std::size_t i = 0; i < framelet_samples; ++i) {
                child.body[i] = (i % 4 == 2) != (most == static_body) ? static_body : BodyNumber{7};
                child.red[i] = child.green[i] = child.blue[i] = child.body[i] == static_body ? 0.0f : 1e6f;
            }
            merge_child(child, 1, will_be_moved, geometry, display);
            float const share = most == static_body ? (will_be_moved ? 0.0f : 0.25f) : 0.75f;
            for (std::size_t i = 0; i < framelet_samples / 4; ++i) {
                ASSERT_EQ(geometry.body[i], most);
                ASSERT_NEAR(display.green[i], srgb_byte_from_linear(share), 1);
            }
        }
    }
}

/// Leaves with holes of less than a pixel.
Scene fine_scene() {
    Scene scene;
    Material leaf = matte({0.2f, 0.8f, 0.2f});
    leaf.alpha_mode = AlphaMode::mask;
    leaf.double_sided = true;
    leaf.base_color_texture.texture = add_texture(scene, 64, 64, [](int x, int y) {
        bool const hole = (x / 3 + y / 5) % 2 != 0;
        return std::array<std::uint8_t, 4>{255, static_cast<std::uint8_t>(4 * x), 255,
                                           static_cast<std::uint8_t>(hole ? 0 : 255)};
    });
    scene.materials = {leaf, matte(Vec3(0.7f))};
    add(scene, quad({-2, -2, 0}, {4, 0.3f, 0}, {0, 4, -1}, 0));
    add(scene, sphere({0, 0, -2}, 1.5f, 1));
    return scene;
}

TEST(DisplayRenderer, FourRaysASampleAverageToTheDirectPictureOf64APixel) {
    Scene const scene = fine_scene();
    RenderScene const ready(scene, Environment::default_sky());
    Viewport const viewport{24, 20};
    ImagePlane const plane(viewport);
    Camera const view = look_at({0.5f, 0.4f, 6}, {0, 0, 0}, {0, 1, 0}, 0.8f);
    ViewRays const rays = make_view_rays(view, viewport);
    Picture const direct = render_picture(ready, view, viewport, 1.5f, 8);
    Framelet scratch, geometry;
    DisplayFramelet display;
    double four = 0, one = 0;
    for (int y = 0; y < viewport.height; y += 4) {
        for (int x = 0; x < viewport.width; x += 4) {
            Tile const tile =
                make_tile(plane.max_depth(), static_cast<std::uint32_t>(x / 4), static_cast<std::uint32_t>(y / 4));
            auto const error = [&](int rays_per_sample) {
                std::uint32_t const segments =
                    render_display(ready, rays, plane, tile, 1.5f, rays_per_sample, false, scratch, geometry, display);
                EXPECT_GE(segments, static_cast<std::uint32_t>(framelet_samples * rays_per_sample));
                EXPECT_EQ(display.tile, tile);
                EXPECT_EQ(geometry.tile, tile);
                double most = 0;
                for (std::uint32_t pixel = 0; pixel < 16; ++pixel) {
                    float sum = 0;
                    for (std::uint32_t i = 16 * pixel; i < 16 * (pixel + 1); ++i) {
                        sum += linear_from_srgb_byte(display.green[i]) / 16;
                    }
                    auto const shown = static_cast<int>(srgb_byte_from_linear(sum));
                    auto const row = y + static_cast<int>(morton_y(pixel));
                    auto const column = x + static_cast<int>(morton_x(pixel));
                    most = std::max<double>(most, std::abs(shown - direct.row(row)[column * 4 + 1]));
                }
                return most;
            };
            one = std::max(one, error(single_ray));
            four = std::max(four, error(four_rays));
        }
    }
    EXPECT_LE(four, 1);
    EXPECT_GT(one, 2) << "the scene has nothing that needs four";
}

} // namespace
} // namespace framelet
