#include "server/stream/layers/layer_fit.h"

#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace framelet {
namespace {

ImagePlane const plane({128, 128});
Tile const tile = make_tile(plane.pixel_depth(), 3, 2);
LayerTolerance const tolerance{0.001f, 1.0f};

/// A framelet with these depths: `depth(x, y)` with x and y in pixels from the tile's corner.
Framelet make_framelet(std::function<float(float, float)> const& depth, Tile of = tile) {
    Framelet framelet{};
    framelet.tile = of;
    float const spacing = plane.sample_spacing(of);
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        framelet.depth[i] = depth((static_cast<float>(morton_x(i)) + 0.5f) * spacing,
                                  (static_cast<float>(morton_y(i)) + 0.5f) * spacing);
    }
    return framelet;
}

float layer_value(Framelet const& framelet, Layer const& layer, std::size_t sample) {
    float const spacing = plane.sample_spacing(framelet.tile);
    auto const i = static_cast<std::uint32_t>(sample);
    return layer.at + layer.dx * (static_cast<float>(morton_x(i)) + 0.5f) * spacing +
           layer.dy * (static_cast<float>(morton_y(i)) + 0.5f) * spacing;
}

/// The drift of a layer where a sample of a framelet lies.
Drift drift_at(Framelet const& framelet, Layer const& layer, std::size_t sample) {
    auto const i = static_cast<std::uint32_t>(sample);
    Vec2 const place(static_cast<float>(morton_x(i)) + 0.5f, static_cast<float>(morton_y(i)) + 0.5f);
    return layer.drift.at(plane.sample_spacing(framelet.tile) * place);
}

/// Expects of a shape what every shape owes its framelet.
void expect_sound(Framelet const& framelet, FrameletShape const& shape, LayerTolerance const& allowed) {
    ASSERT_LE(shape.layer_count, max_layers);
    float const coarse = std::max(1.0f, plane.sample_spacing(framelet.tile));
    float nearest = 0;
    for (float const depth : framelet.depth) {
        nearest = std::max(nearest, 1 / depth);
    }
    for (std::size_t l = 0; l < shape.layer_count; ++l) {
        Layer const& layer = shape.layers[l];
        ASSERT_TRUE(std::isfinite(layer.at) && std::isfinite(layer.dx) && std::isfinite(layer.dy));
        Drift const drift = layer.drift.at(Vec2(static_cast<float>(plane.tile_side(framelet.tile))));
        ASSERT_TRUE(std::isfinite(glm::dot(drift.velocity + drift.acceleration, Vec3(1)) + drift.jerk));
        float const most = std::max(wide_tolerances * allowed.inverse_depth * coarse, 1e-6f * nearest);
        float const size = std::abs(layer.at) + static_cast<float>(plane.tile_side(framelet.tile)) *
                                                    (std::abs(layer.dx) + std::abs(layer.dy));
        ASSERT_LE(layer.error, 1.001f * isolated_tolerances * most + 1e-5f * size);
    }
    std::size_t outliers = 0;
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        BodyNumber const body = framelet.body.empty() ? static_body : framelet.body[i];
        Drift const drift = framelet.drift.empty() ? Drift{} : framelet.drift[i];
        float const inverse = 1 / framelet.depth[i];
        if (shape.layer_of[i] == FrameletShape::outlier) {
            ASSERT_LT(outliers, shape.outliers.size());
            EXPECT_EQ(shape.outliers[outliers], (Outlier{inverse, body, drift}));
            ++outliers;
        } else {
            ASSERT_LT(shape.layer_of[i], shape.layer_count);
            Layer const& layer = shape.layers[shape.layer_of[i]];
            ASSERT_EQ(layer.body, body);
            ASSERT_LE(std::abs(inverse - layer_value(framelet, layer, i)), layer.error) << i;
            ASSERT_LE(glm::length(drift_at(framelet, layer, i).velocity - drift.velocity) * inverse,
                      1.001f * isolated_tolerances * allowed.velocity * coarse + 1e-6f);
        }
    }
    ASSERT_EQ(outliers, shape.outliers.size());
}

FrameletShape fit(Framelet const& framelet, LayerTolerance const& allowed = tolerance) {
    FrameletShape shape;
    fit_layers(framelet, plane, allowed, shape);
    expect_sound(framelet, shape, allowed);
    return shape;
}

float slope(float x, float y) {
    return 1 / (0.2f + 0.004f * x - 0.006f * y);
}
float sky(float, float) {
    return INFINITY;
}

TEST(LayerFit, APlaneIsOneLayerAtAnySpacing) {
    for (int depth = plane.min_depth(); depth <= plane.max_depth(); ++depth) {
        Tile const of = make_tile(depth, 0, 0);
        float const spacing = plane.sample_spacing(of);
        Framelet const framelet = make_framelet([&](float x, float y) { return slope(x / spacing, y / spacing); }, of);
        FrameletShape const shape = fit(framelet);
        ASSERT_EQ(shape.layer_count, 1);
        EXPECT_TRUE(shape.outliers.empty());
        EXPECT_NEAR(shape.layers[0].at, 0.2f, 1e-5f);
        EXPECT_NEAR(shape.layers[0].dx * spacing, 0.004f, 1e-6f);
        EXPECT_NEAR(shape.layers[0].dy * spacing, -0.006f, 1e-6f);
        EXPECT_LT(shape.layers[0].error, 1e-6f);
    }
}

TEST(LayerFit, SkyIsALayerAtInfinity) {
    FrameletShape const all = fit(make_framelet(sky));
    ASSERT_EQ(all.layer_count, 1);
    EXPECT_EQ(all.layers[0], Layer{});
    FrameletShape const edge = fit(make_framelet([](float x, float y) { return x + y < 14 ? slope(x, y) : INFINITY; }));
    ASSERT_EQ(edge.layer_count, 2);
    EXPECT_TRUE(edge.outliers.empty());
    EXPECT_EQ(edge.layers[0], Layer{}) << "the larger part";
    EXPECT_NEAR(edge.layers[1].dx, 0.004f, 1e-5f);
}

TEST(LayerFit, ASilhouetteIsTwoLayers) {
    FrameletShape const shape = fit(make_framelet(
        [](float x, float y) { return 3 * x - y < 17 ? slope(x, y) : 1 / (0.7f - 0.01f * x + 0.002f * y); }));
    EXPECT_EQ(shape.layer_count, 2);
    EXPECT_TRUE(shape.outliers.empty());
}

TEST(LayerFit, AnEdgeOfARoomIsTwoLayersAndACornerThree) {
    FrameletShape const edge =
        fit(make_framelet([](float x, float) { return 1 / (0.3f - 0.01f * std::abs(x - 6.3f)); }));
    EXPECT_EQ(edge.layer_count, 2);
    EXPECT_TRUE(edge.outliers.empty());
    FrameletShape const corner = fit(make_framelet([](float x, float y) {
        float const a = 0.3f - 0.01f * (x - 8), b = 0.3f + 0.012f * (x - 8), c = 0.3f - 0.02f * (y - 7);
        return 1 / std::max({a, b, c});
    }));
    EXPECT_EQ(corner.layer_count, 3);
    EXPECT_LE(corner.outliers.size(), 4u);
}

TEST(LayerFit, AThinPoleBeforeAWall) {
    FrameletShape const shape = fit(
        make_framelet([](float x, float y) { return std::abs(x - 7) < 1 ? 1 / (0.9f + 0.003f * y) : slope(x, y); }));
    EXPECT_EQ(shape.layer_count, 2);
    EXPECT_TRUE(shape.outliers.empty());
}

TEST(LayerFit, FewSamplesThatFitNowhereAreOutliers) {
    Framelet framelet = make_framelet(slope);
    for (std::size_t i : {std::size_t{3}, std::size_t{77}, std::size_t{200}}) {
        framelet.depth[i] *= 0.5f;
    }
    FrameletShape const shape = fit(framelet);
    EXPECT_EQ(shape.layer_count, 1);
    EXPECT_EQ(shape.outliers.size(), 3u);
}

TEST(LayerFit, AnIsolatedSampleNearALayerOfItsBodyLiesOnIt) {
    Framelet framelet = make_framelet(slope);
    auto const move = [&](std::size_t i, float tolerances) {
        framelet.depth[i] = 1 / (1 / framelet.depth[i] + tolerances * tolerance.inverse_depth);
    };
    move(3, 0.8f * isolated_tolerances);
    move(77, -0.8f * isolated_tolerances);
    move(200, 1.5f * isolated_tolerances);
    framelet.body.assign(framelet_samples, static_body);
    framelet.body[120] = 1;
    FrameletShape const shape = fit(framelet);
    EXPECT_EQ(shape.layer_count, 1);
    EXPECT_EQ(shape.outliers.size(), 2u) << "one is far off, one on another body";
    EXPECT_EQ(shape.layer_of[3], 0);
    EXPECT_EQ(shape.layer_of[77], 0);
}

TEST(LayerFit, BodiesAreLayersOfTheirOwnEvenOnOnePlane) {
    Framelet framelet = make_framelet(slope);
    framelet.body.assign(framelet_samples, 7);
    EXPECT_EQ(fit(framelet).layer_count, 1);
    EXPECT_EQ(fit(framelet).layers[0].body, 7);
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        framelet.body[i] = morton_x(i) < 5 ? 2 : 0;
    }
    FrameletShape const shape = fit(framelet);
    ASSERT_EQ(shape.layer_count, 2);
    EXPECT_EQ(shape.layers[0].body, 0);
    EXPECT_EQ(shape.layers[1].body, 2);
    EXPECT_TRUE(shape.outliers.empty());
}

TEST(LayerFit, MoreBodiesThanLayersMakeTheSmallestOutliers) {
    Framelet framelet = make_framelet(slope);
    framelet.body.resize(framelet_samples);
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        framelet.body[i] = static_cast<BodyNumber>(i);
    }
    EXPECT_EQ(fit(framelet).outliers.size(), std::size_t{framelet_samples});
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        framelet.body[i] = static_cast<BodyNumber>(std::min(morton_x(i) / 3, 4u));
    }
    FrameletShape const shape = fit(framelet);
    EXPECT_EQ(shape.layer_count, 3);
    EXPECT_EQ(shape.outliers.size(), 96u);
}

TEST(LayerFit, WhatDeformsSharesALayerWhereItMovesAlike) {
    Framelet framelet = make_framelet(slope);
    framelet.drift.assign(framelet_samples, {});
    EXPECT_EQ(fit(framelet).layer_count, 1);
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        if (morton_x(i) < 8) {
            framelet.drift[i].velocity = Vec3(2, 0, 0.5f * static_cast<float>(morton_y(i)));
        }
    }
    FrameletShape const alike = fit(framelet);
    ASSERT_EQ(alike.layer_count, 2);
    EXPECT_TRUE(alike.outliers.empty());
    EXPECT_NEAR(alike.layers[0].drift.corner.velocity.x + alike.layers[1].drift.corner.velocity.x, 2, 1e-4f);
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        framelet.drift[i].velocity = Vec3(100 * static_cast<float>((i + 1) * (i + 7) % 251), 0, 0);
    }
    EXPECT_EQ(fit(framelet).outliers.size(), std::size_t{framelet_samples});
}

TEST(LayerFit, AMovingShadowIsALayerOfItsOwnOnThePlaneOfWhatIsLit) {
    Vec3 const passing(5.5f, 0, -2.25f);
    Framelet framelet = make_framelet(slope);
    FrameletShape const lit = fit(framelet);
    ASSERT_EQ(lit.layer_count, 1);
    framelet.drift.assign(framelet_samples, {});
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        framelet.drift[i].velocity = morton_x(i) < 8 ? passing : Vec3(0);
    }
    FrameletShape const shape = fit(framelet);
    ASSERT_EQ(shape.layer_count, 2);
    EXPECT_TRUE(shape.outliers.empty());
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        Drift const drift = drift_at(framelet, shape.layers[shape.layer_of[i]], i);
        EXPECT_LT(glm::distance(drift.velocity, framelet.drift[i].velocity), 1e-4f) << i;
    }
    for (std::size_t l = 0; l < 2; ++l) {
        EXPECT_NEAR(shape.layers[l].at, lit.layers[0].at, 1e-5f);
        EXPECT_NEAR(shape.layers[l].dx, lit.layers[0].dx, 1e-6f);
        EXPECT_NEAR(shape.layers[l].dy, lit.layers[0].dy, 1e-6f);
        EXPECT_EQ(shape.layers[l].body, static_body);
    }
}

TEST(LayerFit, AFewThatMoveOtherwiseDoNotBendTheVelocityOfTheOthers) {
    Framelet framelet = make_framelet(slope);
    framelet.drift.assign(framelet_samples, {Vec3(20, 0, 1)});
    for (std::uint32_t i = 0; i < framelet_samples; i += 10) {
        framelet.drift[i].velocity = Vec3(60, 5, -30);
    }
    FrameletShape const shape = fit(framelet);
    ASSERT_EQ(shape.layer_count, 2);
    EXPECT_LT(glm::distance(drift_at(framelet, shape.layers[0], 100).velocity, Vec3(20, 0, 1)), 1e-3f);
    EXPECT_LT(glm::distance(drift_at(framelet, shape.layers[1], 100).velocity, Vec3(60, 5, -30)), 1e-3f);
    EXPECT_TRUE(shape.outliers.empty());
}

TEST(LayerFit, NoiseAboveTheToleranceIsOfOutliersAndBelowItIsNot) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform(-1, 1);
    auto const noisy = [&](float amount) {
        return make_framelet(
            [&, amount](float x, float y) { return 1 / (1 / slope(x, y) + amount * uniform(random)); });
    };
    FrameletShape const quiet = fit(noisy(0.9f * tolerance.inverse_depth));
    EXPECT_EQ(quiet.layer_count, 1);
    EXPECT_TRUE(quiet.outliers.empty());
    EXPECT_GT(fit(noisy(30 * tolerance.inverse_depth)).outliers.size(), 150u);
}

TEST(LayerFit, WithoutAnyToleranceTheShapeIsOverwrittenAsWell) {
    Framelet const framelet = make_framelet([](float, float) { return 4.0f; });
    FrameletShape shape;
    shape.layer_count = 3;
    shape.layer_of.fill(2);
    fit_layers(framelet, plane, {}, shape);
    EXPECT_EQ(shape.layer_count, 1);
    EXPECT_EQ(shape.layers[0].at, 0.25f);
    EXPECT_EQ(shape.layer_of[77], 0);
}

TEST(LayerFit, MedianDepthAndTolerance) {
    std::vector<Framelet> framelets{make_framelet(sky),
                                    make_framelet([](float x, float) { return x < 6 ? 2.0f : 5.0f; })};
    EXPECT_EQ(median_depth(framelets), 5);
    EXPECT_EQ(median_depth(std::span(framelets).first(1)), 1);
    ViewRays const rays = make_view_rays(Camera{}, {128, 128});
    LayerTolerance const t = layer_tolerance(5, rays, 0);
    float const focal = 1 / glm::length(rays.direction_dx), move = 20 * 5 / focal;
    EXPECT_NEAR(t.inverse_depth * move * focal, 0.25f, 1e-6f);
    EXPECT_NEAR(t.velocity * 0.1f * focal, 0.25f, 1e-5f);
    EXPECT_EQ(t.preferred_inverse_depth, 0);
    EXPECT_EQ(layer_tolerance(5, rays, 0.01f).preferred_inverse_depth, 0) << "slow";
    EXPECT_NEAR(layer_tolerance(5, rays, 8).preferred_inverse_depth * 8 * 0.2f * focal, 0.1f, 1e-6f);
    EXPECT_NEAR(layer_tolerance(5, rays, 1e9f).preferred_inverse_depth * 5 * focal, 0.1f, 1e-6f) << "a jump";
}

TEST(LayerFit, FitsCloserWhereThatLeavesFewOutliers) {
    auto const roof = [](float x, float) { return 1 / (0.2f + 0.001f * std::abs(x - 8)); };
    LayerTolerance wanted{0.01f, 1, 0};
    FrameletShape const rough = fit(make_framelet(roof), wanted);
    EXPECT_EQ(rough.layer_count, 1);
    wanted.preferred_inverse_depth = 1e-5f;
    FrameletShape const close = fit(make_framelet(roof), wanted);
    EXPECT_EQ(close.layer_count, 2);
    EXPECT_TRUE(close.outliers.empty());
    EXPECT_LT(close.layers[0].error, 2e-5f);
    auto const rubble = [](float x, float y) { return 1 / (0.2f + 0.005f * std::sin(x * x * 31 + y * 17)); };
    EXPECT_EQ(fit(make_framelet(rubble), wanted).layer_count, 1);
    EXPECT_TRUE(fit(make_framelet(rubble), wanted).outliers.empty());
}

/// The samples are patches of planes at depths of all sizes, with bodies, velocities, sky and noise.
TEST(LayerFit, BoundsHoldWhateverTheSamples) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0, 1);
    auto const some_depth = [&] { return 0.03f * std::pow(2000 / 0.03f, unit(random)); };
    constexpr std::array<float, 6> hard{1e-6f, 1e-3f, 1e8f, 1e15f, 3e38f, INFINITY};
    FrameletShape shape;
    for (int round = 0; round < 20000; ++round) {
        std::array<float, 3> at, dx, dy;
        for (std::size_t p = 0; p < 3; ++p) {
            at[p] = 1 / some_depth();
            dx[p] = at[p] * 0.05f * (unit(random) - 0.5f);
            dy[p] = at[p] * 0.05f * (unit(random) - 0.5f);
        }
        float const noise = round % 3 == 0 ? 0.0f : std::pow(10.0f, -7 * unit(random));
        float const a = unit(random) * 32 - 8, b = unit(random) * 2 - 1;
        int const kind = round % 7;
        Tile const of = make_tile(plane.min_depth() + round % (plane.max_depth() - plane.min_depth() + 1), 0, 0);
        float const cell = 1 / plane.sample_spacing(of);
        Framelet framelet = make_framelet(
            [&](float px, float py) {
                float const x = px * cell, y = py * cell;
                std::size_t const p = kind == 0 || x + b * y < a ? 0 : y < 7 ? 1 : 2;
                if ((kind == 4 && p == 1) || (kind == 6 && unit(random) < 0.3f)) {
                    return hard[random() % hard.size()];
                }
                float const inverse = at[p] + dx[p] * x + dy[p] * y;
                return 1 / std::max(inverse * (1 + noise * (unit(random) - 0.5f)), 1e-9f);
            },
            of);
        if (kind % 3 == 2) {
            framelet.body.resize(framelet_samples);
            for (std::size_t i = 0; i < framelet_samples; ++i) {
                bool const is_sky = std::isinf(framelet.depth[i]);
                framelet.body[i] = is_sky ? static_body : static_cast<BodyNumber>(i / (1 + random() % 256));
            }
        }
        if (kind == 5) {
            framelet.drift.resize(framelet_samples);
            for (std::size_t i = 0; i < framelet_samples; ++i) {
                if (!std::isinf(framelet.depth[i])) {
                    framelet.drift[i] = {Vec3(unit(random), 0, a), Vec3(0, b, unit(random)), 100 * unit(random)};
                }
            }
        }
        LayerTolerance const allowed{0.0125f / some_depth(), 0.01f};
        SCOPED_TRACE(round);
        fit_layers(framelet, plane, allowed, shape); // again and again into the same shape
        expect_sound(framelet, shape, allowed);
        if (HasFatalFailure()) {
            return;
        }
    }
}

} // namespace
} // namespace framelet
