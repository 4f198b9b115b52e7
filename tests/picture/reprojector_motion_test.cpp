#include "common/picture/reprojector.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "common/color.h"
#include "common/picture/reconstruction.h"
#include "tests/picture/moved_room.h"

namespace framelet {
namespace {

struct Agreement {
    int seen = 0, right_depth = 0, half = 0, tenth = 0, compared = 0;
    int unseen = 0, unseen_holes = 0, seen_holes = 0;
};

/// Compares a picture with what rays hit. Distances: difference of a wave over its slope, where it is steep.
Agreement compare(AnalyticScene const& scene, Camera const& source, SceneTime source_time, Camera const& display,
                  SceneTime display_time, Shown const& shown, double margin = 1.5) {
    Agreement out;
    std::vector<Quad> const placed = scene.at_time(display_time);
    ViewRays const rays = make_view_rays(display, viewport);
    auto const square = [](double value) { return value * value / (255.0 * 255.0); };
    for (int y = 1; y + 1 < viewport.height; ++y) {
        for (int x = 1; x + 1 < viewport.width; ++x) {
            auto const expected =
                scene.expect(source, source_time, display, display_time, viewport, x + 0.5, y + 0.5, margin);
            float const depth = shown.inverse_depth[at(x, y)];
            bool const hole = depth == hole_depth;
            if (!expected.was_seen) {
                bool const none =
                    !scene.expect(source, source_time, display, display_time, viewport, x + 0.5, y + 0.5, 0).was_seen;
                out.unseen += none ? 1 : 0;
                out.unseen_holes += none && hole ? 1 : 0;
                continue;
            }
            ++out.seen;
            out.seen_holes += hole ? 1 : 0;
            out.right_depth += std::abs(static_cast<double>(depth) - expected.hit.inverse_depth) <=
                                       1e-3 * expected.hit.inverse_depth + 1e-6
                                   ? 1
                                   : 0;
            if (expected.hit.quad < 0) {
                continue;
            }
            for (int channel = 0; channel < 2; ++channel) {
                auto const k = static_cast<std::size_t>(channel);
                auto const wave = [&](double px, double py) {
                    return square(static_cast<double>(scene.cast(placed, rays, px, py).color[k]));
                };
                double const slope = std::hypot(wave(x + 0.7, y + 0.5) - wave(x + 0.3, y + 0.5),
                                                wave(x + 0.5, y + 0.7) - wave(x + 0.5, y + 0.3)) /
                                     0.4;
                if (slope > 0.05 && slope < 0.1) {
                    double const value = square(shown.picture.row(y)[4 * x + channel]);
                    double const distance = std::abs(value - wave(x + 0.5, y + 0.5)) / slope;
                    ++out.compared;
                    out.half += distance < 0.5 ? 1 : 0;
                    out.tenth += distance < 0.1 ? 1 : 0;
                }
            }
        }
    }
    return out;
}

TEST(ReprojectorMotion, FindsTheRightPlacesFromAnotherCamera) {
    AnalyticScene const scene = room();
    Camera const display = look_at(Vec3(0.35f, 1.7f, 5.7f), Vec3(0.05f, 0.95f, 0), Vec3(0, 1, 0), 0.8f);
    Shown const shown = show(filled(scene, front(), 0), display, 0);
    Agreement const got = compare(scene, front(), 0, display, 0, shown);
    EXPECT_GT(got.seen, 40000);
    EXPECT_GT(got.compared, 4000);
    EXPECT_GE(got.right_depth, 0.999 * got.seen);
    EXPECT_EQ(got.seen_holes, 0);
    EXPECT_GE(got.half, 0.995 * got.compared);
    EXPECT_GE(got.tenth, 0.90 * got.compared);
    EXPECT_GT(got.unseen, 500);
    EXPECT_GE(got.unseen_holes, 0.8 * got.unseen); // a rim of half a sample is covered by what stands beside it
}

TEST(ReprojectorMotion, OutliersFindTheirPlacesToo) {
    AnalyticScene const scene = room();
    Camera const display = look_at(Vec3(0.25f, 1.6f, 5.8f), Vec3(0.05f, 0.95f, 0), Vec3(0, 1, 0), 0.8f);
    Shown const shown = show(filled(scene, front(), 0, 0, true), display, 0);
    Agreement const got = compare(scene, front(), 0, display, 0, shown, 2.5);
    EXPECT_GT(got.seen, 30000);
    EXPECT_LE(got.seen_holes, 0.001 * got.seen);
    EXPECT_GE(got.half, 0.95 * got.compared);
}

TEST(ReprojectorMotion, BodiesAndWhatDeformsMove) {
    AnalyticScene scene = room();
    BodyTrack track{5, 0, {}};
    for (int i = 0; i <= 60; ++i) {
        auto const time = static_cast<float>(i) / body_keys_per_second;
        track.keys.push_back({Vec3(0.6f * time, 0, 0), glm::angleAxis(0.7f * time, Vec3(0, 0, 1)), Vec3(1)});
    }
    scene.motions.extend(track);
    scene.quads[2].body = 5;
    scene.quads[1].velocity = {0.4, 0, 0.1};
    for (Camera const& display :
         {front(), look_at(Vec3(0.2f, 1.6f, 5.8f), Vec3(0.05f, 0.95f, 0), Vec3(0, 1, 0), 0.8f)}) {
        Shown const shown = show(filled(scene, front(), 0, 0.2), display, 0.6, scene.motions);
        Agreement const got = compare(scene, front(), 0.2, display, 0.6, shown);
        EXPECT_GT(got.seen, 40000);
        EXPECT_GE(got.right_depth, 0.998 * got.seen);
        EXPECT_GE(got.half, 0.995 * got.compared);
        EXPECT_GE(got.tenth, 0.90 * got.compared);
    }
}

TEST(ReprojectorMotion, OnePlaneHasNoCracksWhateverTheTiles) {
    AnalyticScene scene;
    scene.quads.push_back({{-60, -60, -40}, {120, 0, 0}, {0, 120, 20}, plain(200, 150, 100)});
    ImagePlane const plane(viewport);
    std::mt19937 random(9);
    FrameletPool pool(plane);
    std::uint64_t number = 0;
    for (Tile const tile : visible_tiles(plane, plane.min_depth())) {
        pool.insert(scene.batch(plane, ++number, front(), 0, {tile}), scene.motions);
    }
    for (int i = 0; i < 300; ++i) {
        pool.insert(scene.batch(plane, ++number, front(), 0, {random_tile(plane, random)}), scene.motions);
    }
    Camera const nearer = look_at(Vec3(1, 1, 2), Vec3(0.5f, 1.2f, 0), Vec3(0.1f, 1, 0), 0.5f);
    Shown const shown = show(pool, nearer, 0);
    int seen = 0;
    for (int y = 0; y < viewport.height; ++y) {
        for (int x = 0; x < viewport.width; ++x) {
            if (scene.expect(front(), 0, nearer, 0, viewport, x + 0.5, y + 0.5, 0).was_seen) {
                ++seen;
                ASSERT_GE(shown.inverse_depth[at(x, y)], 0) << x << "," << y;
                ASSERT_EQ(shown.picture.row(y)[4 * x], 200) << x << "," << y;
                ASSERT_EQ(shown.picture.row(y)[4 * x + 1], 150);
            }
        }
    }
    EXPECT_GT(seen, viewport.width * viewport.height * 9 / 10);
}

TEST(ReprojectorMotion, CoarseAndFineSamplesAreInterpolatedAndAveraged) {
    AnalyticScene scene;
    auto const ramp = [](double u, double) {
        return Color{static_cast<float>(255 * std::sqrt(u)), 100, static_cast<float>(255 * std::sqrt(1 - u))};
    };
    scene.quads.push_back({{-8, -8, -2}, {16, 0, 0}, {0, 16, 0}, ramp});
    Camera const display = look_at(Vec3(0.31f, 1.4f, 5.9f), Vec3(0.31f, 1, 0), Vec3(0, 1, 0), 0.8f);
    std::vector<Quad> const placed = scene.at_time(0);
    ViewRays const rays = make_view_rays(display, viewport);
    for (int levels = -coarsest_levels; levels <= finest_levels; ++levels) {
        Shown const shown = show(filled(scene, front(), levels), display, 0);
        for (int y = 20; y < viewport.height - 20; y += 3) {
            for (int x = 24; x < viewport.width - 24; ++x) {
                Color const expected = scene.cast(placed, rays, x + 0.5, y + 0.5).color;
                ASSERT_NEAR(shown.picture.row(y)[4 * x], expected[0], 1.6) << levels << " at " << x << "," << y;
                ASSERT_NEAR(shown.picture.row(y)[4 * x + 2], expected[2], 1.6) << levels << " at " << x << "," << y;
            }
        }
    }
}

TEST(ReprojectorMotion, HolesBehindAMovingEdgeTakeTheBackground) {
    AnalyticScene scene;
    scene.quads.push_back({{-20, -20, -4}, {40, 0, 0}, {0, 40, 0}, plain(40, 160, 80)});
    scene.quads.push_back({{-1, 0, 1}, {2, 0, 0}, {0, 2, 0}, plain(250, 20, 20)});
    Camera display = front();
    display.position.x += 0.8f;
    Shown const shown = show(filled(scene, front(), 0), display, 0);
    int holes = 0;
    for (int y = 0; y < viewport.height; ++y) {
        for (int x = 0; x < viewport.width; ++x) {
            if (shown.inverse_depth[at(x, y)] == hole_depth) {
                ++holes;
                ASSERT_NEAR(shown.picture.row(y)[4 * x], 40, 1) << x << "," << y;
                ASSERT_NEAR(shown.picture.row(y)[4 * x + 1], 160, 1) << x << "," << y;
            }
        }
    }
    EXPECT_GT(holes, 1000);
    EXPECT_NEAR(shown.hole_share, holes / static_cast<double>(viewport.width * viewport.height), 1e-9);
}

TEST(ReprojectorMotion, SkyTurnsExactly) {
    AnalyticScene scene;
    scene.sky = [](glm::dvec3 direction) {
        auto const wave = [](double phase) { return static_cast<float>(255 * std::sqrt(0.5 + 0.4 * std::sin(phase))); };
        return Color{wave(60 * direction.x), wave(60 * direction.y), 128};
    };
    Camera display = front();
    display.orientation = glm::normalize(glm::angleAxis(0.1f, Vec3(0.3f, 0.9f, 0.2f)) * display.orientation);
    display.position += Vec3(3, 0, -2); // which makes no difference to the sky
    Shown const shown = show(filled(scene, front(), 0), display, 0);
    ViewRays const rays = make_view_rays(display, viewport);
    int seen = 0;
    for (int y = 0; y < viewport.height; ++y) {
        for (int x = 0; x < viewport.width; ++x) {
            if (scene.expect(front(), 0, display, 0, viewport, x + 0.5, y + 0.5, 1).was_seen) {
                ++seen;
                Color const expected = scene.cast({}, rays, x + 0.5, y + 0.5).color;
                ASSERT_NEAR(shown.picture.row(y)[4 * x], expected[0], 6) << x << "," << y;
                ASSERT_NEAR(shown.picture.row(y)[4 * x + 1], expected[1], 6) << x << "," << y;
                ASSERT_EQ(shown.inverse_depth[at(x, y)], 0);
            }
        }
    }
    EXPECT_GT(seen, 30000);
}

TEST(ReprojectorMotion, NewerWinsOnOneSurfaceNearerWinsElse) {
    AnalyticScene old_scene, new_scene;
    old_scene.quads.push_back({{-20, -20, -4}, {40, 0, 0}, {0, 40, 0}, plain(50, 50, 50)});
    new_scene.quads.push_back({{-20, -20, -4}, {40, 0, 0}, {0, 40, 0}, plain(90, 90, 90)});
    old_scene.quads.push_back({{-1, 0, 1}, {2, 0, 0}, {0, 2, 0}, plain(200, 200, 200)});
    ImagePlane const plane(viewport);
    FrameletPool pool(plane);
    std::vector<Tile> const all = visible_tiles(plane, plane.pixel_depth());
    pool.insert(old_scene.batch(plane, 1, front(), 0, all), old_scene.motions);
    std::vector<Tile> left; // tiles beside those that show the board
    for (Tile const tile : all) {
        if (tile.column() < 5) {
            left.push_back(tile);
        }
    }
    Camera aside = front();
    aside.position.x -= 0.5f;
    pool.insert(new_scene.batch(plane, 2, aside, 0, left), new_scene.motions);
    Camera display = front();
    display.position.x -= 0.1f;
    Shown const shown = show(pool, display, 0);
    EXPECT_EQ(shown.picture.row(90)[4 * 20], 90);
    EXPECT_EQ(shown.picture.row(90)[4 * 300], 50);
    EXPECT_EQ(shown.picture.row(90)[4 * 163], 200);
}

TEST(ReprojectorMotion, WhatMayBeFarOffItsPlaceShowsBeforeNothing) {
    AnalyticScene scene;
    scene.quads.push_back({{-20, -20, -4}, {40, 0, 0}, {0, 40, 0}, plain(50, 50, 50)});
    scene.quads.push_back({{-1, 0, 1}, {2, 0, 0}, {0, 2, 0}, plain(200, 200, 200)});
    AnalyticScene bare = scene;
    bare.quads.pop_back();
    ImagePlane const plane(viewport);
    std::vector<Tile> const all = visible_tiles(plane, plane.pixel_depth());
    std::vector<Tile> const coarse = visible_tiles(plane, plane.pixel_depth() - coarsest_levels);
    Camera display = front();
    display.position.x -= 0.1f;
    display.position.z -= 1; // coarse samples hide nothing from so near
    for (bool const is_sure : {true, false}) {
        Batch batch = scene.batch(plane, 1, front(), 0, all);
        for (FrameletShape& shape : batch.shapes) {
            for (Layer& layer : std::span(shape.layers).first(shape.layer_count)) {
                layer.error = is_sure ? layer.error : 10 * layer.at;
            }
        }
        FrameletPool pool(plane);
        pool.insert(batch, scene.motions);
        EXPECT_EQ(show(pool, display, 0).picture.row(90)[4 * 163], 200) << "there is nothing else";
        Camera aside = front();
        aside.position.x -= 0.5f;
        pool.insert(bare.batch(plane, 2, aside, 0, coarse),
                    bare.motions); // as if the board were not seen from there
        EXPECT_EQ(show(pool, display, 0).picture.row(90)[4 * 163], is_sure ? 200 : 50);
    }
}

TEST(ReprojectorMotion, StrangeCamerasAndShapesGiveNumbers) {
    ImagePlane const plane(viewport);
    std::mt19937 random(2);
    std::normal_distribution<float> normal;
    AnalyticScene const scene = room();
    for (int round = 0; round < 30; ++round) {
        Batch batch = scene.batch(plane, 1, front(), 0, visible_tiles(plane, plane.pixel_depth()), round % 3 == 0);
        for (FrameletShape& shape : batch.shapes) {
            for (Layer& layer : shape.layers) {
                layer.at += round % 2 == 0 ? 0 : normal(random);
                layer.dx += round % 2 == 0 ? 0 : 0.1f * normal(random);
                layer.drift.corner.velocity =
                    Vec3(normal(random), 0, normal(random)) * std::pow(10.0f, 4 * normal(random));
            }
        }
        FrameletPool pool(plane);
        pool.insert(batch, scene.motions);
        Camera camera =
            look_at(3.0f * Vec3(normal(random), normal(random), normal(random)),
                    Vec3(normal(random), normal(random), normal(random)), Vec3(0, 1, 0), round % 4 == 0 ? 3.0f : 0.8f);
        Shown const shown = show(pool, camera, round * 1e3);
        for (std::size_t i = 0; i < shown.inverse_depth.size(); ++i) {
            ASSERT_TRUE(std::isfinite(shown.inverse_depth[i]));
            ASSERT_EQ(shown.picture.rgba[4 * i + 3], 255);
        }
    }
}

} // namespace
} // namespace framelet
