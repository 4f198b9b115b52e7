#include "common/reprojector.h"

#include <algorithm>
#include <map>
#include <random>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "common/color.h"
#include "common/reconstruction.h"
#include "tests/common/analytic_scene.h"
#include "tests/common/synthetic_framelets.h"

namespace framelet {
namespace {

constexpr Viewport viewport{320, 192};

Camera front() {
    return look_at(Vec3(0, 1.5f, 6), Vec3(0, 1, 0), Vec3(0, 1, 0), 0.8f);
}

/// A floor, a wall behind and a board in front of it.
AnalyticScene room() {
    AnalyticScene scene;
    scene.quads.push_back({{-8, 0, -3}, {16, 0, 0}, {0, 0, 16}, waves(12, 6)});
    scene.quads.push_back({{-8, 0, -3}, {16, 0, 0}, {0, 3, 0}, waves(12, 2)});
    scene.quads.push_back({{-0.8, 0.3, 1}, {1.4, 0, 0.3}, {0, 1.4, 0}, waves(2, 2)});
    return scene;
}

struct Shown {
    Picture picture{viewport.width, viewport.height};
    std::vector<float> inverse_depth;
    double hole_share = 0;
};

Shown show(FrameletCache const& cache, Camera const& camera, SceneTime time, BodyMotions const& motions = {}) {
    Shown out;
    Reprojector reprojector;
    std::vector<PixelRect> repainted;
    reprojector.show(cache, {}, camera, time, motions, out.picture, repainted);
    out.inverse_depth.assign(reprojector.inverse_depth().begin(), reprojector.inverse_depth().end());
    out.hole_share = reprojector.hole_share();
    return out;
}

FrameletCache filled(AnalyticScene const& scene, Camera const& camera, int levels, SceneTime time = 0,
                     bool all_loose = false) {
    ImagePlane const plane(viewport);
    FrameletCache cache(plane);
    cache.insert(scene.batch(plane, 1, camera, time, visible_tiles(plane, plane.pixel_depth() + levels), all_loose));
    return cache;
}

std::size_t at(int x, int y) {
    return static_cast<std::size_t>(y) * viewport.width + static_cast<std::size_t>(x);
}

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

TEST(Reprojector, StillPictureIsReconstruct) {
    ImagePlane const plane(viewport);
    std::mt19937 random(4);
    FrameletCache cache(plane);
    AnalyticScene const scene = room();
    Reprojector reprojector;
    Picture picture(viewport.width, viewport.height), expected = picture;
    std::vector<PixelRect> changed, repainted;
    for (std::uint64_t number = 1; number < 40; ++number) {
        std::vector<Tile> tiles;
        for (int i = 0; i < 20; ++i) {
            Tile const tile = random_tile(plane, random);
            if (std::ranges::find(tiles, tile) == tiles.end()) {
                tiles.push_back(tile);
            }
        }
        cache.insert(scene.batch(plane, number, front(), 0.1 * static_cast<double>(number), tiles));
        cache.take_changed(changed);
        reprojector.show(cache, changed, front(), 7, {}, picture, repainted);
        reconstruct_all(cache, expected);
        ASSERT_TRUE(reprojector.is_exact());
        ASSERT_EQ(picture, expected);
    }
    reprojector.show(cache, {}, front(), 8, {}, picture, repainted);
    EXPECT_TRUE(repainted.empty());
}

TEST(Reprojector, FindsTheRightPlacesFromAnotherCamera) {
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

TEST(Reprojector, LooseSamplesFindTheirPlacesToo) {
    AnalyticScene const scene = room();
    Camera const display = look_at(Vec3(0.25f, 1.6f, 5.8f), Vec3(0.05f, 0.95f, 0), Vec3(0, 1, 0), 0.8f);
    Shown const shown = show(filled(scene, front(), 0, 0, true), display, 0);
    Agreement const got = compare(scene, front(), 0, display, 0, shown, 2.5);
    EXPECT_GT(got.seen, 30000);
    EXPECT_LE(got.seen_holes, 0.001 * got.seen);
    EXPECT_GE(got.half, 0.95 * got.compared);
}

TEST(Reprojector, BodiesAndWhatDeformsMove) {
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

TEST(Reprojector, BodiesThatHaveComeToRestAreExact) {
    AnalyticScene scene = room();
    BodyTrack track{5, 0, {}};
    for (int i = 0; i <= 60; ++i) { // moves until 0.5 s
        auto const time = static_cast<float>(std::min(i, 30)) / body_keys_per_second;
        track.keys.push_back({Vec3(0.6f * time, 0, 0), glm::angleAxis(0.7f * time, Vec3(0, 0, 1)), Vec3(1)});
    }
    scene.motions.extend(track);
    scene.quads[2].body = 5;
    FrameletCache const cache = filled(scene, front(), 2, 0.55);
    Picture exact(viewport.width, viewport.height);
    reconstruct_all(cache, exact);
    EXPECT_EQ(show(cache, front(), 0.9, scene.motions).picture, exact);
    EXPECT_NE(show(cache, front(), 0.2, scene.motions).picture, exact);
}

TEST(Reprojector, AfterACutWhatIsHeldStaysWhereItIs) {
    AnalyticScene const scene = room();
    FrameletCache const cache = filled(scene, front(), 0);
    Picture unmoved(viewport.width, viewport.height);
    reconstruct_all(cache, unmoved);
    Camera away = front();
    away.orientation = glm::angleAxis(3.0f, Vec3(0, 1, 0)) * away.orientation;
    Camera aside = front();
    aside.orientation = glm::angleAxis(0.3f, Vec3(0, 1, 0)) * aside.orientation;
    Reprojector reprojector;
    Picture picture(viewport.width, viewport.height);
    std::vector<PixelRect> repainted;
    for (Camera const& camera : {aside, away, away, aside, front(), away}) {
        reprojector.show(cache, {}, camera, 0, {}, picture, repainted);
        if (camera == aside) {
            EXPECT_EQ(picture, show(cache, aside, 0).picture);
        } else {
            EXPECT_EQ(picture, unmoved);
            EXPECT_EQ(reprojector.hole_share(), camera == away ? 1 : 0);
        }
    }
}

TEST(Reprojector, OnePlaneHasNoCracksWhateverTheTiles) {
    AnalyticScene scene;
    scene.quads.push_back({{-60, -60, -40}, {120, 0, 0}, {0, 120, 20}, plain(200, 150, 100)});
    ImagePlane const plane(viewport);
    std::mt19937 random(9);
    FrameletCache cache(plane);
    std::uint64_t number = 0;
    for (Tile const tile : visible_tiles(plane, plane.min_depth())) {
        cache.insert(scene.batch(plane, ++number, front(), 0, {tile}));
    }
    for (int i = 0; i < 300; ++i) {
        cache.insert(scene.batch(plane, ++number, front(), 0, {random_tile(plane, random)}));
    }
    Camera const nearer = look_at(Vec3(1, 1, 2), Vec3(0.5f, 1.2f, 0), Vec3(0.1f, 1, 0), 0.5f);
    Shown const shown = show(cache, nearer, 0);
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

TEST(Reprojector, CoarseAndFineSamplesAreInterpolatedAndAveraged) {
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

TEST(Reprojector, HolesBehindAMovingEdgeTakeTheBackground) {
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

TEST(FarMeans, LargeHolesBesideGroundAreNotFilledWithSky) {
    constexpr int side = 8;
    FarMean const sky{100, 200, 300, 0};
    FarMean const ground{40, 30, 20, 0.1f};
    std::vector<FarMean> blocks(side * side, ground);
    std::fill_n(blocks.begin(), side * side / 2, sky);
    for (int const hole : {6 * side + 6, 6 * side + 7, 7 * side + 6, 7 * side + 7}) {
        blocks[static_cast<std::size_t>(hole)] = {};
    }
    FarMeans means;
    means.make(blocks, side, side);
    EXPECT_EQ(means.at(0, 0), sky);
    EXPECT_NEAR(means.at(7, 7).red, ground.red, 12);
    EXPECT_NEAR(means.at(7, 7).blue, ground.blue, 60);
    means.make(std::vector<FarMean>(side * side), side, side);
    EXPECT_EQ(means.at(3, 3), FarMean{});
}

TEST(Reprojector, SkyTurnsExactly) {
    AnalyticScene scene;
    scene.sky = [](glm::dvec3 direction) {
        auto const wave = [](double phase) { return static_cast<float>(255 * std::sqrt(0.5 + 0.4 * std::sin(phase))); };
        return Color{wave(60 * direction.x), wave(60 * direction.y), 128};
    };
    Camera display = front();
    display.orientation = glm::normalize(glm::angleAxis(0.1f, Vec3(0.3f, 0.9f, 0.2f)) * display.orientation);
    display.position += Vec3(3, 0, -2); // which makes no difference
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

TEST(Reprojector, NewerWinsOnOneSurfaceNearerWinsElse) {
    AnalyticScene old_scene, new_scene;
    old_scene.quads.push_back({{-20, -20, -4}, {40, 0, 0}, {0, 40, 0}, plain(50, 50, 50)});
    new_scene.quads.push_back({{-20, -20, -4}, {40, 0, 0}, {0, 40, 0}, plain(90, 90, 90)});
    old_scene.quads.push_back({{-1, 0, 1}, {2, 0, 0}, {0, 2, 0}, plain(200, 200, 200)});
    ImagePlane const plane(viewport);
    FrameletCache cache(plane);
    std::vector<Tile> const all = visible_tiles(plane, plane.pixel_depth());
    cache.insert(old_scene.batch(plane, 1, front(), 0, all));
    std::vector<Tile> left; // of places beside those that show the board
    for (Tile const tile : all) {
        if (tile.column() < 5) {
            left.push_back(tile);
        }
    }
    Camera aside = front();
    aside.position.x -= 0.5f;
    cache.insert(new_scene.batch(plane, 2, aside, 0, left));
    Camera display = front();
    display.position.x -= 0.1f;
    Shown const shown = show(cache, display, 0);
    EXPECT_EQ(shown.picture.row(90)[4 * 20], 90);
    EXPECT_EQ(shown.picture.row(90)[4 * 300], 50);
    EXPECT_EQ(shown.picture.row(90)[4 * 163], 200);
}

/// Cameras and contents that change now and then: what is kept from the last picture is right, whatever the threads.
TEST(Reprojector, IncrementalEqualsWholeAndThreadsMakeNoDifference) {
    ImagePlane const plane(viewport);
    AnalyticScene scene = room();
    scene.motions.extend({5, 0, {BodyPose{}, BodyPose{Vec3(0.3f, 0, 0)}, BodyPose{Vec3(0.5f, 0.1f, 0)}}});
    scene.quads[2].body = 5;
    std::mt19937 random(12);
    FrameletCache cache(plane);
    Reprojector kept;
    Picture picture(viewport.width, viewport.height);
    std::vector<PixelRect> changed, repainted;
    Camera camera = front();
    int partial = 0;
    for (std::uint64_t number = 1; number < 40; ++number) {
        std::vector<Tile> tiles = number == 1 ? visible_tiles(plane, plane.pixel_depth()) : std::vector<Tile>{};
        for (int i = 0; i < 6; ++i) {
            Tile const tile = random_tile(plane, random);
            if (std::ranges::find(tiles, tile) == tiles.end()) {
                tiles.push_back(tile);
            }
        }
        double const time = static_cast<double>(number / 4) / body_keys_per_second;
        cache.insert(scene.batch(plane, number, camera, time, tiles));
        if (number % 5 == 0) {
            camera.position += Vec3(0.05f, 0.02f, -0.1f);
        }
        cache.take_changed(changed);
        Picture const before = picture;
        kept.show(cache, changed, camera, time, scene.motions, picture, repainted);
        Shown whole;
        {
            tbb::global_control const threads(tbb::global_control::max_allowed_parallelism, number % 2 == 0 ? 1 : 2);
            whole = show(cache, camera, time, scene.motions);
        }
        ASSERT_EQ(picture, whole.picture) << number;
        if (!kept.is_exact()) {
            ASSERT_TRUE(std::ranges::equal(kept.inverse_depth(), whole.inverse_depth));
        }
        std::vector<std::uint8_t> covered(static_cast<std::size_t>(viewport.width * viewport.height));
        std::size_t area = 0;
        for (PixelRect const& rect : repainted) {
            for (int y = rect.top; y < rect.bottom; ++y) {
                for (int x = rect.left; x < rect.right; ++x) {
                    covered[at(x, y)] = 1;
                    ++area;
                }
            }
        }
        partial += area < covered.size() ? 1 : 0;
        for (std::size_t i = 0; i < covered.size(); ++i) {
            if (covered[i] == 0) {
                ASSERT_TRUE(std::equal(&picture.rgba[4 * i], &picture.rgba[4 * i] + 4, &before.rgba[4 * i]));
            }
        }
        kept.show(cache, {}, camera, time, scene.motions, picture, repainted);
        ASSERT_TRUE(repainted.empty());
        ASSERT_EQ(picture, whole.picture);
    }
    EXPECT_GT(partial, 20);
}

TEST(Reprojector, StrangeCamerasAndShapesGiveNumbers) {
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
                layer.velocity = Vec3(normal(random), 0, normal(random)) * std::pow(10.0f, 4 * normal(random));
            }
        }
        FrameletCache cache(plane);
        cache.insert(batch);
        Camera camera =
            look_at(3.0f * Vec3(normal(random), normal(random), normal(random)),
                    Vec3(normal(random), normal(random), normal(random)), Vec3(0, 1, 0), round % 4 == 0 ? 3.0f : 0.8f);
        Shown const shown = show(cache, camera, round * 1e3);
        for (std::size_t i = 0; i < shown.inverse_depth.size(); ++i) {
            ASSERT_TRUE(std::isfinite(shown.inverse_depth[i]));
            ASSERT_EQ(shown.picture.rgba[4 * i + 3], 255);
        }
    }
}

TEST(Reprojector, NoShapeLeavesWhatIsNotANumber) {
    ImagePlane const plane(viewport);
    std::mt19937 random(7);
    std::array const strange{NAN, INFINITY, -INFINITY, 3e38f, -3e38f, 1e17f, 1e-40f, 0.0f};
    auto const any = [&] { return strange[random() % strange.size()]; };
    AnalyticScene const scene = room();
    Camera aside = front();
    aside.position.x += 0.2f;
    for (int round = 0; round < 24; ++round) {
        int const levels = round % 4 - 1;
        Batch batch =
            scene.batch(plane, 1, front(), 0, visible_tiles(plane, plane.pixel_depth() + levels), round % 5 == 0);
        for (FrameletShape& shape : batch.shapes) {
            for (Layer& layer : shape.layers) {
                std::array const fields{&layer.at,    &layer.dx,         &layer.dy,
                                        &layer.error, &layer.velocity.x, &layer.velocity.y};
                *fields[random() % fields.size()] = any();
            }
            for (LooseSample& loose : shape.loose_samples) {
                (random() % 2 == 0 ? loose.inverse_depth : loose.velocity.z) = any();
            }
        }
        FrameletCache cache(plane);
        cache.insert(batch);
        Shown const shown = show(cache, round % 3 == 0 ? front() : aside, 0.1);
        for (std::size_t i = 0; i < shown.inverse_depth.size(); ++i) {
            ASSERT_TRUE(std::isfinite(shown.inverse_depth[i]));
        }
    }
}

TEST(Reprojector, OrthographicStays) {
    AnalyticScene const scene = room();
    Camera orthographic = front();
    orthographic.projection = Projection::orthographic;
    orthographic.vertical_extent = 5;
    FrameletCache const cache = filled(scene, orthographic, 0);
    Camera aside = orthographic;
    aside.position.x += 1;
    Picture expected(viewport.width, viewport.height);
    reconstruct_all(cache, expected);
    EXPECT_EQ(show(cache, aside, 0).picture, expected);
}

} // namespace
} // namespace framelet
