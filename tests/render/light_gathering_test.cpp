// Light that the cache has gathered, against what is known of it by mathematics.
#include "server/render/gathering/light_gathering.h"

#include <gtest/gtest.h>

#include "box_scene.h"
#include "scene_builder.h"
#include "server/render/path/path_picture.h"
#include "tests/settled_light.h"

namespace framelet {
namespace {

using namespace test;

constexpr Viewport viewport{48, 32};
constexpr std::size_t most_paths = 4'000'000;

TEST(LightGathering, WhiteSurfacesInAWhiteFurnaceAreWhite) {
    for (float const metallic : {0.0f, 1.0f}) {
        Scene scene;
        Material white = matte(Vec3(1));
        white.metallic = metallic;
        white.roughness = 0.7f;
        scene.materials.push_back(white);
        add(scene, quad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}, 0));
        add(scene, sphere({0, 0.6f, 0}, 0.6f, 0));
        RenderScene ready(scene, Environment::uniform(Vec3(1)));
        CachedLight light(ready, {}, 8);
        Camera const camera = look_at({0, 1.5f, 4}, {0, 0.5f, 0}, {0, 1, 0}, 0.8f);
        EXPECT_LT(light.settle(camera, viewport, most_paths), most_paths);
        double sum = 0;
        FloatImage const picture = render_radiance(ready, camera, viewport, 1);
        for (Vec3 const& pixel : picture.rgb) {
            EXPECT_NEAR(pixel.g, 1, 0.06f);
            sum += double(pixel.g) / double(picture.rgb.size());
        }
        EXPECT_NEAR(sum, 1, 0.01) << metallic;
    }
}

TEST(LightGathering, GreyBoxAgreesWithRadiosity) {
    GreyBox const box;
    RenderScene ready(box.scene, black());
    PathOptions options;
    options.lambertian = true;
    CachedLight light(ready, options, 2);
    constexpr float cell = 1.0f / 32;
    auto const shade_at = [&](GreyBox::Point const& p) {
        Wall const wall = cube_walls()[static_cast<std::size_t>(p.wall)];
        IncomingLight in;
        light.cache().look_up({0, wall.at(p.u, p.v) + wall.normal() * 1e-5f, wall.normal()}, cell, in);
        return double(in.all.g);
    };
    auto const around = [](GreyBox::Point p, int i) { // and the cells that are interpolated
        p.u += cell * static_cast<float>(i % 3 - 1);
        p.v += cell * static_cast<float>(i / 3 - 1);
        return p;
    };
    for (GreyBox::Point const& p : GreyBox::points) {
        for (int i = 0; i < 9; ++i) {
            shade_at(around(p, i));
        }
    }
    while (light.gathering().work(8192) > 0) {
    }
    double bias = 0;
    for (GreyBox::Point const& p : GreyBox::points) {
        for (int i = 0; i < 9; ++i) {
            double const expected = box.arriving(around(p, i));
            double const off = shade_at(around(p, i)) / expected - 1;
            EXPECT_LT(std::abs(off), 0.07) << p.wall << " " << p.u << " " << p.v << " " << i;
            bias += off / (9 * double(GreyBox::points.size()));
        }
    }
    EXPECT_LT(std::abs(bias), 0.01);
}

/// A room that a lamp lights through a door, in the renderer's own shading.
TEST(LightGathering, APictureByTheCacheIsThatOfPaths) {
    Scene scene = cube(matte(Vec3(0.7f)));
    scene.materials.push_back(matte({0.7f, 0.2f, 0.1f}));
    add(scene, quad({0.5f, 0, 0}, {0, 0, 0.6f}, {0, 1, 0}, 1));
    add(scene, quad({0.5f, 0, 0.6f}, {0, 0, -0.6f}, {0, 1, 0}, 1));
    Light lamp;
    lamp.type = LightType::point;
    lamp.intensity = 2;
    add_light(scene, lamp, {0.25f, 0.8f, 0.3f}, {0, -1, 0});
    RenderScene ready(scene, black());
    Camera const camera = look_at({0.95f, 0.5f, 0.9f}, {0.3f, 0.4f, 0.3f}, {0, 1, 0}, 1.2f);
    PathOptions options;
    options.paths = 256;
    FloatImage const truth = render_paths(ready, camera, viewport, options);
    CachedLight light(ready, {}, 2);
    EXPECT_LT(light.settle(camera, viewport, most_paths), most_paths);
    EXPECT_EQ(light.settle(camera, viewport, most_paths), 0u) << "what is good enough asks for nothing";
    FloatImage const shown = render_radiance(ready, camera, viewport, 4);
    double sum = 0, all = 0;
    for (std::size_t i = 0; i < truth.rgb.size(); ++i) {
        sum += double(shown.rgb[i].g - truth.rgb[i].g);
        all += double(truth.rgb[i].g);
    }
    EXPECT_LT(std::abs(sum / all), 0.02);
}

/// A box that a lamp lights, which can be moved.
struct LampBox {
    Scene scene = cube(matte(Vec3(0.6f)));
    std::unique_ptr<RenderScene> ready;
    Camera camera = look_at({0.95f, 0.6f, 0.9f}, {0.3f, 0.3f, 0.3f}, {0, 1, 0}, 1.2f);

    LampBox() {
        Light lamp;
        lamp.type = LightType::point;
        lamp.intensity = 1;
        add_light(scene, lamp, {0.2f, 0.8f, 0.2f}, {0, -1, 0});
        ready = std::make_unique<RenderScene>(scene, black());
    }
    void move_lamp(Vec3 const& to) {
        ScenePose pose = evaluate_pose(scene, {}, 0);
        pose.world_from_node.back()[3] = Vec4(to, 1);
        ready->set_pose(pose);
    }
    FloatImage truth() const {
        PathOptions options;
        options.paths = 128;
        return render_paths(*ready, camera, viewport, options);
    }
    double error(FloatImage const& truth) const {
        FloatImage const shown = render_radiance(*ready, camera, viewport, 1);
        double off = 0, all = 0;
        for (std::size_t i = 0; i < truth.rgb.size(); ++i) {
            off += std::abs(double(shown.rgb[i].g - truth.rgb[i].g));
            all += double(truth.rgb[i].g);
        }
        return off / all;
    }
};

TEST(LightGathering, FollowsALampThatMoves) {
    LampBox box;
    CachedLight light(*box.ready, {}, 2);
    light.settle(box.camera, viewport, most_paths);
    std::size_t const records = light.cache().records().size();
    box.move_lamp({0.7f, 0.3f, 0.5f});
    light.update();
    FloatImage const truth = box.truth();
    double const before = box.error(truth);
    std::size_t const some = 64 * records;
    for (std::size_t done = 0, turns = 0; done < some && turns < some; ++turns) {
        done += light.gathering().work(1024);
    }
    double const after = box.error(truth);
    EXPECT_GT(before, 0.12) << "what has changed is much";
    EXPECT_LT(after, 0.06) << before;
    light.settle(box.camera, viewport, most_paths);
    EXPECT_LT(box.error(truth), 0.05) << "the noise of both";
}

TEST(LightGathering, APoseThatChangesNoLightCostsAPathARecord) {
    LampBox box;
    CachedLight light(*box.ready, {}, 2);
    light.settle(box.camera, viewport, most_paths);
    light.update();
    std::size_t done = 0;
    while (std::size_t const some = light.gathering().work(1024)) {
        done += some;
    }
    EXPECT_LE(done, light.cache().records().size());
    EXPECT_GT(done, light.cache().records().size() / 2);
}

/// The time that paths take, as a share of what samples take, where the light is off by `error`.
double time_of_paths(double path_seconds, double error) {
    LearningShare share;
    share.note_error(error);
    double paths_took = 0, samples_took = 0;
    constexpr std::size_t samples = 6400;
    for (int i = 0; i < 2000; ++i) {
        std::size_t const paths = share.paths_beside(samples);
        double const held_up = i % 50 == 0 ? 3 : 1; // by another program
        share.note(samples, samples * 1.5e-6 * held_up, paths, static_cast<double>(paths) * path_seconds);
        if (i > 200) {
            samples_took += samples * 1.5e-6 * held_up;
            paths_took += static_cast<double>(paths) * path_seconds;
        }
    }
    return paths_took / samples_took;
}

TEST(LearningShare, PathsTakeAsMuchTimeAsTheLightIsOff) {
    for (double const path_seconds : {2e-6, 30e-6}) {
        EXPECT_NEAR(time_of_paths(path_seconds, 1), 0.5, 0.05) << path_seconds;
        EXPECT_NEAR(time_of_paths(path_seconds, 0.1), 0.2, 0.02) << path_seconds;
        EXPECT_NEAR(time_of_paths(path_seconds, 0), 0.125, 0.0125) << path_seconds;
    }
}

TEST(LearningShare, WhatTookNoTimeAtAllAsksForNothingBoundless) {
    LearningShare share;
    for (int i = 0; i < 1000; ++i) {
        share.note(256, 1e-3, 4096, 0);
        share.note(0, 0, 0, 0);
    }
    EXPECT_LT(share.paths_beside(256), 1u << 24);
}

} // namespace
} // namespace framelet
