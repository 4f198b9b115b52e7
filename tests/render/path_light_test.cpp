#include "server/render/path/path_light.h"

#include <numbers>

#include <gtest/gtest.h>

#include "common/color.h"
#include "common/morton.h"
#include "scene_builder.h"
#include "server/render/path/path_picture.h"
#include "tests/uniform_tiling.h"

namespace framelet {
namespace {

using namespace test;

constexpr Viewport viewport{32, 32};
constexpr LampSizes sizes{0.01f, 0.1f};

/// A ball on a floor under a lamp.
struct LitBall {
    Scene scene;
    std::unique_ptr<RenderScene> render_scene;
    Camera camera = look_at({0, 1.5f, 4}, {0, 0.5f, 0}, {0, 1, 0}, 0.8f);

    LitBall() {
        scene.materials = {matte(Vec3(0.7f)), matte({0.8f, 0.2f, 0.1f})};
        add(scene, quad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}, 0));
        add(scene, sphere({0, 0.6f, 0}, 0.6f, 1));
        Light lamp;
        lamp.type = LightType::point;
        lamp.intensity = 8;
        add_light(scene, lamp, {1, 2.5f, 1}, {0, -1, 0});
        render_scene = std::make_unique<RenderScene>(scene, Environment::uniform(Vec3(0.1f)));
    }
};

struct Traced {
    FloatImage picture{viewport.width, viewport.height};
    double squared_error = 0; ///< mean, as it is said to be
};

/// A picture of the sums of so many paths, which come in these steps.
Traced traced(LitBall const& ball, std::vector<int> const& steps) {
    PathOptions options;
    options.sizes = sizes;
    PathLight const light(ball.render_scene->prepared(), options);
    ImagePlane const plane(viewport);
    ViewRays const view = make_view_rays(ball.camera, viewport);
    PathSums sums;
    sums.hold(plane);
    auto const tiles = make_uniform_tiling(plane, plane.pixel_depth()).tiles;
    Traced out;
    for (Tile const tile : tiles) {
        Framelet framelet;
        framelet.tile = tile;
        for (int const paths : steps) {
            TileLight brought;
            for (int path = first_to_add(sums[tile], paths); path < paths; ++path) {
                trace_tile(light, view, plane, tile, path, brought);
                add_path(brought, sums[tile]);
            }
            set_means(sums[tile], framelet);
        }
        out.squared_error += static_cast<double>(squared_error(sums[tile], 1)) / static_cast<double>(tiles.size());
        PixelRect const rect = plane.tile_rect(tile);
        for (std::uint32_t i = 0; i < framelet_samples; ++i) {
            out.picture.at(rect.left + static_cast<int>(morton_x(i)), rect.top + static_cast<int>(morton_y(i))) =
                Vec3(framelet.red[i], framelet.green[i], framelet.blue[i]);
        }
    }
    return out;
}

FloatImage pictured(LitBall const& ball, int paths, std::uint32_t seed) {
    PathOptions options;
    options.paths = paths;
    options.seed = seed;
    options.sizes = sizes;
    return render_paths(*ball.render_scene, ball.camera, viewport, options);
}

TEST(PathLight, SumsAreOfTheSamePathsAsAPicture) {
    LitBall const ball;
    FloatImage const wanted = pictured(ball, 32, 0);
    Traced const steps = traced(ball, {4, 16, 32});
    EXPECT_EQ(steps.picture.rgb, traced(ball, {32}).picture.rgb) << "however they come";
    for (std::size_t i = 0; i < wanted.rgb.size(); ++i) {
        EXPECT_LT(glm::length(steps.picture.rgb[i] - wanted.rgb[i]), 1e-4f * (0.1f + glm::length(wanted.rgb[i])));
    }
}

TEST(PathLight, AsManyPathsAgainBeginAnew) {
    LitBall const ball;
    EXPECT_EQ(traced(ball, {16, 64, 4}).picture.rgb, traced(ball, {4}).picture.rgb);
}

/// The paths of a pixel are stratified: errors are below those of independent ones, by which they are judged.
TEST(PathLight, TheErrorIsNoGreaterThanItIsSaidToBe) {
    LitBall const ball;
    FloatImage const truth = pictured(ball, 4096, 1);
    EXPECT_TRUE(std::isinf(traced(ball, {4}).squared_error)) << "so few do not tell";
    for (int const paths : {16, 64, 256}) {
        Traced const found = traced(ball, {paths});
        double sum = 0;
        for (std::size_t i = 0; i < truth.rgb.size(); ++i) {
            auto const shown = [&](Vec3 const& radiance) {
                return srgb_from_linear(glm::dot(tone_map(radiance), Vec3(0.2126f, 0.7152f, 0.0722f)));
            };
            double const off = static_cast<double>(shown(found.picture.rgb[i]) - shown(truth.rgb[i]));
            sum += off * off / static_cast<double>(truth.rgb.size());
        }
        EXPECT_LT(sum, 1.2 * found.squared_error) << paths;
        EXPECT_GT(sum, 0.05 * found.squared_error) << paths;
    }
}

TEST(PathLight, LampsAreAsLargeAsIsSaidOrTheSceneAllows) {
    Bounds room{Vec3(0), Vec3(10)}, toy{Vec3(0), Vec3(1, 0, 0)};
    EXPECT_FLOAT_EQ(lamp_sizes({}, room).lamp, 0.05f);
    EXPECT_FLOAT_EQ(lamp_sizes({}, toy).lamp, 0.005f);
    EXPECT_FLOAT_EQ(lamp_sizes({.lamp_metres = 0.3f}, toy).lamp, 0.15f);
    EXPECT_EQ(lamp_sizes({.lamp_metres = 0.0f}, room).lamp, 0);
    EXPECT_NEAR(lamp_sizes({.sun_degrees = 2}, room).sun, std::numbers::pi / 180, 1e-6);
}

TEST(PathLight, SumsAreAsLargeAsIsSaid) {
    PathSums sums;
    EXPECT_TRUE(sums.empty());
    sums.hold(ImagePlane({64, 48}));
    EXPECT_LE(12 * sizeof(TileSums), PathSums::bytes_per_pixel * 64 * 48);
    sums[make_tile(2, 3, 2)].paths = 7;
    sums.hold(ImagePlane({64, 48}));
    EXPECT_EQ(sums[make_tile(2, 3, 2)].paths, 7) << "the same picture";
    sums.clear();
    EXPECT_TRUE(sums.empty());
}

} // namespace
} // namespace framelet
