// Light adds up: what many lamps give is known from scenes of few of them each, whose shadows are exact.
#include "server/render/trace/lamp_light.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "scene_builder.h"
#include "server/render/picture_renderer.h"

namespace framelet {
namespace {

using namespace test;

constexpr int across = 15; ///< lamps along a side of their grid

/// A floor with posts below a grid of lamps, every `step`th from `first` on lit.
Scene lit_by(int first, int step, bool has_posts, float roughness = 0.6f) {
    Scene scene;
    scene.materials.push_back(matte(Vec3(0.5f)));
    scene.materials.back().roughness = roughness;
    add(scene, quad({-12, 0, 12}, {24, 0, 0}, {0, 0, -24}, 0));
    for (int i = 0; has_posts && i < 36; ++i) {
        Vec3 const foot(3.0f * static_cast<float>(i % 6) - 7.6f, 0, 3.0f * static_cast<float>(i / 6) - 7.3f);
        for (Vec3 const side : {Vec3(0.4f, 0, 0), Vec3(0, 0, 0.4f)}) {
            add(scene, quad(foot - 0.5f * side, side, {0, 1.2f, 0}, 0));
            add(scene, quad(foot + 0.5f * side, -side, {0, 1.2f, 0}, 0));
        }
    }
    for (int i = first; i < across * across; i += step) {
        Light lamp;
        lamp.intensity = 0.4f + 0.1f * static_cast<float>(i % 5);
        lamp.color = i % 3 == 0 ? Vec3(1, 0.6f, 0.3f) : Vec3(0.7f, 0.8f, 1);
        add_light(scene, lamp,
                  {1.5f * static_cast<float>(i % across) - 10.4f, 2.1f, 1.5f * static_cast<float>(i / across) - 10.6f},
                  {0, -1, 0});
    }
    return scene;
}

FloatImage picture_of(Scene const& scene) {
    RenderScene const ready(scene, black());
    return render_radiance(ready, look_at({0, 4, 11}, {0, 0, 0}, {0, 1, 0}, 0.9f), {96, 64}, 1);
}

/// The sum of pictures whose lights each have an exact shadow.
FloatImage exact_picture(bool has_posts, float roughness) {
    constexpr int parts = 15; // of 15 lamps
    static_assert(across * across / parts <= exact_lights);
    FloatImage sum(96, 64);
    for (int part = 0; part < parts; ++part) {
        FloatImage const some = picture_of(lit_by(part, parts, has_posts, roughness));
        for (std::size_t i = 0; i < sum.rgb.size(); ++i) {
            sum.rgb[i] += some.rgb[i];
        }
    }
    return sum;
}

TEST(LampLight, OfManyLampsAddsUpWhereNothingIsInTheWay) {
    for (float const roughness : {1.0f, 0.2f}) {
        FloatImage const exact = exact_picture(false, roughness);
        FloatImage const found = picture_of(lit_by(0, 1, false, roughness));
        for (std::size_t i = 0; i < exact.rgb.size(); ++i) {
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(found.rgb[i][c], exact.rgb[i][c], 2e-4f * exact.rgb[i][c] + 1e-6f);
            }
        }
    }
}

TEST(LampLight, ShadowsOfManyLampsAreNearTheExactOnes) {
    FloatImage const exact = exact_picture(true, 0.6f);
    FloatImage const found = picture_of(lit_by(0, 1, true));
    double sum = 0, difference = 0, bias = 0, worst_block = 0;
    for (std::size_t i = 0; i < exact.rgb.size(); ++i) {
        sum += static_cast<double>(exact.rgb[i].g);
        difference += std::abs(static_cast<double>(found.rgb[i].g - exact.rgb[i].g));
        bias += static_cast<double>(found.rgb[i].g - exact.rgb[i].g);
    }
    for (int y = 0; y < 64; y += 8) {
        for (int x = 0; x < 96; x += 8) {
            double here = 0, off = 0;
            for (int k = 0; k < 64; ++k) {
                here += static_cast<double>(exact.at(x + k % 8, y + k / 8).g);
                off += static_cast<double>(found.at(x + k % 8, y + k / 8).g - exact.at(x + k % 8, y + k / 8).g);
            }
            worst_block = here > 0 ? std::max(worst_block, std::abs(off) / here) : worst_block;
        }
    }
    EXPECT_LT(difference / sum, 0.03);
    EXPECT_LT(std::abs(bias) / sum, 0.01);
    EXPECT_LT(worst_block, 0.05);
    std::printf("mean error %.4f, bias %.4f, of a block at most %.4f\n", difference / sum, bias / sum, worst_block);
}

TEST(LampLight, TakesFewRaysHoweverManyLampsThereAre) {
    Scene const scene = lit_by(0, 1, true);
    RenderScene const ready(scene, black());
    Viewport const viewport{64, 64};
    ImagePlane const plane(viewport);
    ViewRays const view = make_view_rays(look_at({0, 4, 11}, {0, 0, 0}, {0, 1, 0}, 0.9f), viewport);
    Framelet framelet;
    std::uint32_t const rays = render_framelet(ready, view, plane, {1u << (2 * plane.pixel_depth()) | 40u}, framelet);
    EXPECT_LE(rays, framelet_samples * (1 + exact_lights + rays_to_others));
    EXPECT_GT(rays, framelet_samples);
}

} // namespace
} // namespace framelet
