#include "common/layer_joining.h"

#include <random>

#include <gtest/gtest.h>

namespace framelet {
namespace {

/// A layer of framelet `part` of 8x8 whose tiles have a side of 16 pixels and samples, all of which lie on it.
struct TestLayer {
    HeldLayer held;
    std::uint32_t part = 0, layer = 0, view = 0;
};

/// `plane`: from the square's corner on.
TestLayer layer_at(AffinePlane const& plane, std::uint32_t part, std::uint32_t layer) {
    TestLayer out{{}, part, layer};
    double const column = 16.0 * morton_x(part);
    double const row = 16.0 * morton_y(part);
    out.held.layer.at = static_cast<float>(plane(column, row));
    out.held.layer.dx = static_cast<float>(plane.dx);
    out.held.layer.dy = static_cast<float>(plane.dy);
    out.held.last_column = out.held.last_row = 15;
    return out;
}

AffinePlane plane_of(TestLayer const& of) {
    AffinePlane const own{of.held.layer.at, of.held.layer.dx, of.held.layer.dy}; // from the tile's corner on
    return {own(-16.0 * morton_x(of.part), -16.0 * morton_y(of.part)), own.dx, own.dy};
}

PlaneExtent extent_of(TestLayer const& layer) {
    double const column = 16.0 * morton_x(layer.part);
    double const row = 16.0 * morton_y(layer.part);
    return {column, row, column + 16, row + 16};
}

LayerJoining joined(std::vector<TestLayer> const& layers) {
    LayerJoining out;
    out.start(LayerJoining::most_levels, {});
    for (TestLayer const& layer : layers) {
        out.add(layer.held, 1, layer.view, layer.part, layer.layer);
    }
    out.finish();
    return out;
}

/// Those that are joined no further, of more than one.
std::vector<JoinedLayer> tops(LayerJoining const& joining) {
    std::vector<JoinedLayer> out;
    for (JoinedLayer const& layer : joining.layers()) {
        if (!layer.is_joined_further && layer.levels < LayerJoining::most_levels) {
            out.push_back(layer);
        }
    }
    return out;
}

TEST(PlaneFit, OfOnePlaneIsThatPlane) {
    AffinePlane const plane{0.3, 2e-3, -1e-3};
    PlaneSums sums = sums_over(plane, {0, 0, 16, 16});
    sums += sums_over(plane, {16, 0, 20, 3});
    sums += sums_over(plane, {40, 64, 72, 66});
    AffinePlane const fit = fit_plane(sums);
    EXPECT_NEAR(fit.at, plane.at, 1e-12);
    EXPECT_NEAR(fit.dx, plane.dx, 1e-12);
    EXPECT_NEAR(fit.dy, plane.dy, 1e-12);
}

TEST(PlaneFit, IsTheBestOne) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    PlaneExtent const extents[] = {{0, 0, 16, 16}, {16, 0, 32, 8}, {4, 16, 16, 32}};
    AffinePlane planes[3];
    PlaneSums sums;
    for (int i = 0; i < 3; ++i) {
        planes[i] = {normal(random), normal(random), normal(random)};
        sums += sums_over(planes[i], extents[i]);
    }
    auto const error = [&](AffinePlane const& fit) {
        double sum = 0;
        for (int i = 0; i < 3; ++i) {
            for (double y = extents[i].top + 0.125; y < extents[i].bottom; y += 0.25) {
                for (double x = extents[i].left + 0.125; x < extents[i].right; x += 0.25) {
                    double const difference = planes[i](x, y) - fit(x, y);
                    sum += difference * difference;
                }
            }
        }
        return sum;
    };
    AffinePlane const fit = fit_plane(sums);
    for (AffinePlane const& step : {AffinePlane{0.05, 0, 0}, AffinePlane{0, 0.01, 0}, AffinePlane{0, 0, 0.01}}) {
        EXPECT_LT(error(fit), error({fit.at + step.at, fit.dx + step.dx, fit.dy + step.dy}));
        EXPECT_LT(error(fit), error({fit.at - step.at, fit.dx - step.dx, fit.dy - step.dy}));
    }
}

TEST(LayerJoining, TwoPlanesInEveryFrameletAreTwo) {
    std::vector<TestLayer> layers;
    for (std::uint32_t part = 0; part < 64; ++part) {
        layers.push_back(layer_at({0.5, 1e-4, 0}, part, 0));
        layers.push_back(layer_at({0.2, 0, -1e-4}, part, 1));
    }
    std::vector<JoinedLayer> const found = tops(joined(layers));
    ASSERT_EQ(found.size(), 2u);
    EXPECT_NEAR(found[0].plane.at, 0.5, 1e-7);
    EXPECT_NEAR(found[1].plane.at, 0.2, 1e-7);
    EXPECT_EQ(found[0].number, 0);
    EXPECT_EQ(found[1].number, 1);
    for (JoinedLayer const& layer : found) {
        EXPECT_EQ(layer.levels, 0);
        EXPECT_LT(layer.difference, 1e-6);
        EXPECT_EQ(layer.extent.right, 128);
        EXPECT_EQ(layer.extent.bottom, 128);
    }
}

TEST(LayerJoining, OnlyOfOneViewBodyAndVelocity) {
    for (int kind = 0; kind < 4; ++kind) {
        std::vector<TestLayer> layers;
        for (std::uint32_t part = 0; part < 4; ++part) {
            TestLayer layer = layer_at({0.5, 0, 0}, part, 0);
            bool const other = part % 2 == 1;
            layer.view = kind == 1 && other ? 7 : 0;
            layer.held.layer.body = kind == 2 && other ? 7 : static_body;
            layer.held.layer.velocity = Vec3(kind == 3 && other ? 7.0f : 0.0f);
            layers.push_back(layer);
        }
        std::vector<JoinedLayer> const found = tops(joined(layers));
        EXPECT_EQ(found.size(), kind == 0 ? 1u : 2u);
        EXPECT_EQ(found[0].parts[1] != JoinedLayer::no_part, kind == 0);
    }
}

/// Whatever is joined is as near to all layers it was joined of as it says, and in every layer once.
TEST(LayerJoining, DifferencesAreBounds) {
    std::mt19937 random(11);
    std::normal_distribution<double> normal;
    int found = 0, fours = 0;
    for (int round = 0; round < 200; ++round) {
        int const of_each = 1 + round / 4 % 2; // fours of framelets with one layer each are joined by themselves
        std::vector<TestLayer> layers;
        for (std::uint32_t part = 0; part < 64; ++part) {
            for (int i = 0; i < of_each; ++i) {
                double const rough = 3e-4 * (round % 4);
                double const at = 0.3 * (i + 1) * (1 + rough * normal(random));
                layers.push_back(
                    layer_at({at, 1e-3 * i, 1e-5 * rough * normal(random)}, part, static_cast<unsigned>(i)));
            }
        }
        LayerJoining const joining = joined(layers);
        std::span<JoinedLayer const> const all = joining.layers();
        std::vector<int> uses(all.size(), 0);
        for (JoinedLayer const& top : all) {
            if (top.levels == LayerJoining::most_levels) {
                continue;
            }
            for (std::int16_t const part : top.parts) {
                uses[static_cast<std::size_t>(std::max<std::int16_t>(part, 0))] += part >= 0 ? 1 : 0;
            }
            fours += of_each == 1 && top.levels == LayerJoining::most_levels - 1 && top.difference > 0 &&
                             std::ranges::count(top.parts, JoinedLayer::no_part) == 0
                         ? 1
                         : 0;
            std::vector<JoinedLayer const*> below{&top};
            while (!below.empty()) {
                JoinedLayer const& layer = *below.back();
                below.pop_back();
                auto const i = static_cast<std::size_t>(&layer - all.data());
                bool const is_given = i < layers.size();
                AffinePlane const& plane = is_given ? plane_of(layers[i]) : layer.plane;
                PlaneExtent const& extent = is_given ? extent_of(layers[i]) : layer.extent;
                EXPECT_LE(largest_difference(plane, top.plane, extent), top.difference + 1e-12);
                found += layer.levels < LayerJoining::most_levels ? 1 : 0;
                for (std::int16_t const part : layer.parts) {
                    if (part != JoinedLayer::no_part) {
                        below.push_back(&all[static_cast<std::size_t>(part)]);
                    }
                }
            }
        }
        for (std::size_t i = 0; i < all.size(); ++i) {
            EXPECT_EQ(uses[i], all[i].is_joined_further ? 1 : 0);
        }
        EXPECT_LE(all.size(), LayerJoining::most_layers);
    }
    EXPECT_GT(found, 1000);
    EXPECT_GT(fours, 100);
}

TEST(LayerJoining, WhatIsNoNumberStaysAlone) {
    std::vector<TestLayer> layers;
    for (std::uint32_t part = 0; part < 4; ++part) {
        layers.push_back(layer_at({0.5, part == 2 ? NAN : 0.0, 0}, part, 0));
    }
    std::vector<JoinedLayer> const found = tops(joined(layers));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].parts[2], JoinedLayer::no_part);
    EXPECT_NEAR(found[0].plane.at, 0.5, 1e-12);
}

/// Far apart from each other two cost less than what holds both.
TEST(LayerJoining, OnlyWhereThatIsCheaper) {
    std::vector<TestLayer> const layers{layer_at({0.5, 0, 0}, 0, 0), layer_at({0.5, 0, 0}, 63, 0)};
    EXPECT_TRUE(tops(joined(layers)).empty());
    std::vector<TestLayer> const beside{layer_at({0.5, 0, 0}, 0, 0), layer_at({0.5, 0, 0}, 1, 0)};
    EXPECT_EQ(tops(joined(beside)).size(), 1u);
}

} // namespace
} // namespace framelet
