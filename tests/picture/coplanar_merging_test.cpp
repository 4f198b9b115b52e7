#include "common/warp/merging/coplanar_merging.h"

#include <algorithm>
#include <bit>
#include <iterator>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "common/morton.h"

namespace framelet {
namespace {

/// A layer of framelet `part` of 8x8 whose tiles have a side of 16 pixels and samples, all of which lie on it.
struct TestLayer {
    HeldLayer held;
    std::uint32_t part = 0, view = 0;
    std::size_t layer = 0; ///< set by `coplanar`
};

/// A layer of framelet `part` on a plane, whose pixels are from the square's corner.
TestLayer layer_at(AffinePlane const& plane, std::uint32_t part) {
    TestLayer out{{}, part};
    double const column = 16.0 * morton_x(part);
    double const row = 16.0 * morton_y(part);
    out.held.layer.at = static_cast<float>(plane(column, row));
    out.held.layer.dx = static_cast<float>(plane.dx);
    out.held.layer.dy = static_cast<float>(plane.dy);
    out.held.last_column = out.held.last_row = 15;
    return out;
}

PlanePiece piece_of(TestLayer const& of) {
    AffinePlane const own{of.held.layer.at, of.held.layer.dx, of.held.layer.dy}; // from the tile's corner on
    double const column = 16.0 * morton_x(of.part);
    double const row = 16.0 * morton_y(of.part);
    return piece_of(AffinePlane{own(-column, -row), own.dx, own.dy},
                    PlaneExtent{column + of.held.first_column, row + of.held.first_row,
                                column + of.held.last_column + 1, row + of.held.last_row + 1});
}

std::uint64_t bit_of(std::uint32_t part) {
    return std::uint64_t{1} << SquareLayers::index_of(part);
}

bool is_part(CoplanarLayers const& coplanar, TestLayer const& layer) {
    return (coplanar.parts[layer.layer] & bit_of(layer.part)) != 0;
}

int part_count(CoplanarLayers const& coplanar) {
    return std::popcount(coplanar.parts[0]) + std::popcount(coplanar.parts[1]) + std::popcount(coplanar.parts[2]);
}

/// Merges layers, of which those of one part come one after the other.
CoplanarMerging merging_of(std::vector<TestLayer>& layers) {
    SquareLayers square;
    HeldShape shape;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        bool const is_first = i == 0 || layers[i].part != layers[i - 1].part;
        shape.layer_count = static_cast<std::uint8_t>(is_first ? 1 : shape.layer_count + 1);
        layers[i].layer = shape.layer_count - 1u;
        shape.layers[layers[i].layer] = layers[i].held;
        EXPECT_TRUE(square.set(SquareLayers::index_of(layers[i].part), layers[i].view, 1, shape));
    }
    CoplanarMerging out;
    out.merge(square, {});
    return out;
}

/// The planes that were merged from more than one layer.
std::vector<CoplanarLayers> several(CoplanarMerging const& merging) {
    std::vector<CoplanarLayers> out;
    std::ranges::copy_if(merging.coplanar(), std::back_inserter(out),
                         [](CoplanarLayers const& layer) { return part_count(layer) > 1; });
    return out;
}

TEST(PlaneFit, OfOnePlaneIsThatPlane) {
    AffinePlane const plane{0.3, 2e-3, -1e-3};
    PlaneSums sums;
    for (PlaneExtent const& extent : {PlaneExtent{0, 0, 16, 16}, {16, 0, 20, 3}, {40, 64, 72, 66}}) {
        sums += sums_over(piece_of(plane, extent));
    }
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
        sums += sums_over(piece_of(planes[i], extents[i]));
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

TEST(PlaneFit, PiecesKnowHowFarAPlaneIs) {
    std::mt19937 random(17);
    std::normal_distribution<double> normal;
    for (int round = 0; round < 1000; ++round) {
        AffinePlane const own{normal(random), normal(random), normal(random)};
        AffinePlane const plane{normal(random), normal(random), normal(random)};
        PlaneExtent extent{normal(random), normal(random), 0, 0};
        extent.right = extent.left + std::abs(normal(random));
        extent.bottom = extent.top + std::abs(normal(random));
        double most = 0, least = std::numeric_limits<double>::max();
        for (double const x : {extent.left, extent.right}) {
            for (double const y : {extent.top, extent.bottom}) {
                most = std::max(most, std::abs(own(x, y) - plane(x, y)));
                least = std::min(least, plane(x, y));
            }
        }
        PlanePiece const piece = piece_of(own, extent);
        EXPECT_NEAR(largest_difference(piece, plane), most, 1e-12);
        EXPECT_NEAR(least_value(plane, piece), least, 1e-12);
        EXPECT_NEAR(piece.plane()(0.5, 2), own(0.5, 2), 1e-12);
        EXPECT_NEAR(piece.extent().right, extent.right, 1e-12);
        EXPECT_NEAR(piece.extent().top, extent.top, 1e-12);
    }
}

TEST(CoplanarMerging, TwoPlanesInEveryFrameletAreTwo) {
    std::vector<TestLayer> layers;
    for (std::uint32_t part = 0; part < 64; ++part) {
        layers.push_back(layer_at({0.5, 1e-4, 0}, part));
        layers.push_back(layer_at({0.2, 0, -1e-4}, part));
    }
    CoplanarMerging const merging = merging_of(layers);
    ASSERT_EQ(merging.coplanar().size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
        CoplanarLayers const& layer = merging.coplanar()[i];
        EXPECT_NEAR(layer.plane.at, i == 0 ? 0.5 : 0.2, 1e-7);
        EXPECT_EQ(layer.parts[i], ~std::uint64_t{0});
        EXPECT_EQ(layer.parts[1 - i], 0u);
        EXPECT_LT(layer.difference, 1e-6);
        EXPECT_EQ(layer.extent.left, 0);
        EXPECT_EQ(layer.extent.top, 0);
        EXPECT_EQ(layer.extent.right, 128);
        EXPECT_EQ(layer.extent.bottom, 128);
    }
}

TEST(CoplanarMerging, OnlyOfOneViewBodyAndVelocity) {
    for (int kind = 0; kind < 4; ++kind) {
        std::vector<TestLayer> layers;
        for (std::uint32_t part = 0; part < 4; ++part) {
            TestLayer layer = layer_at({0.5, 0, 0}, part);
            bool const other = part % 2 == 1;
            layer.view = kind == 1 && other ? 7 : 0;
            layer.held.layer.body = kind == 2 && other ? 7 : static_body;
            layer.held.layer.drift.corner.velocity = Vec3(kind == 3 && other ? 7.0f : 0.0f);
            layers.push_back(layer);
        }
        CoplanarMerging const merging = merging_of(layers);
        EXPECT_EQ(merging.coplanar().size(), kind == 0 ? 1u : 2u);
        EXPECT_EQ(is_part(merging.coplanar()[0], layers[1]), kind == 0);
        EXPECT_TRUE(is_part(merging.coplanar()[0], layers[2]));
    }
}

/// Whatever is merged is as near to all layers it was merged from as it says, and each layer is in one.
TEST(CoplanarMerging, DifferencesAreBounds) {
    std::mt19937 random(11);
    std::normal_distribution<double> normal;
    int of_quads = 0, of_layers = 0, alone = 0;
    std::ptrdiff_t quads = 0;
    for (int round = 0; round < 200; ++round) {
        int const of_each = 1 + round / 4 % 2; // quads of framelets with one layer each are merged by themselves
        std::vector<TestLayer> layers;
        for (std::uint32_t part = 0; part < 64; ++part) {
            for (int i = 0; i < of_each; ++i) {
                double const rough = 3e-4 * (round % 4);
                double const at = 0.3 * (i + 1) * (1 + rough * normal(random));
                layers.push_back(layer_at({at, 1e-3 * i, 1e-5 * rough * normal(random)}, part));
                HeldLayer& held = layers.back().held;
                if (round % 3 == 0) { // only some of its samples lie on it
                    held.first_column = static_cast<std::int8_t>(random() % 4);
                    held.last_row = static_cast<std::int8_t>(12 + random() % 4);
                }
            }
        }
        CoplanarMerging const merging = merging_of(layers);
        int parts = 0;
        for (CoplanarLayers const& found : merging.coplanar()) {
            parts += part_count(found);
            (part_count(found) == 1 ? alone : of_each == 1 ? of_quads : of_layers) += 1;
            PlaneExtent extent;
            bool is_first = true;
            for (TestLayer const& layer : layers) {
                if (is_part(found, layer)) {
                    PlanePiece const piece = piece_of(layer);
                    double const off = largest_difference(piece, found.plane);
                    EXPECT_LE(off, found.difference + 1e-12);
                    EXPECT_LE(off, 2.002e-3 * least_value(found.plane, piece)); // a quad's share is of the quad's plane
                    extent = is_first ? piece.extent() : united(extent, piece.extent());
                    is_first = false;
                }
            }
            EXPECT_EQ(extent.left, found.extent.left);
            EXPECT_EQ(extent.top, found.extent.top);
            EXPECT_EQ(extent.right, found.extent.right);
            EXPECT_EQ(extent.bottom, found.extent.bottom);
        }
        EXPECT_EQ(static_cast<std::size_t>(parts), layers.size());
        for (CoplanarLayers const& quad : merging.quads()) {
            EXPECT_EQ(part_count(quad), 4);
            for (TestLayer const& layer : layers) {
                if (is_part(quad, layer)) {
                    EXPECT_LE(largest_difference(piece_of(layer), quad.plane), quad.difference + 1e-12);
                }
            }
            quads += std::ranges::count_if(merging.coplanar(), [&](CoplanarLayers const& found) {
                return (quad.parts[0] & ~found.parts[0]) == 0;
            });
        }
        quads -= static_cast<std::ptrdiff_t>(merging.quads().size()); // each quad is in one
        for (TestLayer const& layer : layers) {
            EXPECT_EQ(std::ranges::count_if(merging.coplanar(),
                                            [&](CoplanarLayers const& found) { return is_part(found, layer); }),
                      1);
        }
    }
    EXPECT_EQ(quads, 0);
    EXPECT_GT(of_quads, 100);
    EXPECT_GT(of_layers, 100);
    EXPECT_GT(alone, 20);
}

TEST(CoplanarMerging, WhatIsNoNumberStaysAlone) {
    for (int kind = 0; kind < 2; ++kind) {
        std::vector<TestLayer> layers;
        for (std::uint32_t part = 0; part < 8; ++part) {
            layers.push_back(
                layer_at({kind == 0 && part == 2 ? NAN : 0.5, kind == 1 && part == 2 ? NAN : 0.0, 0}, part));
        }
        std::vector<CoplanarLayers> const found = several(merging_of(layers));
        ASSERT_EQ(found.size(), 1u);
        EXPECT_FALSE(is_part(found[0], layers[2]));
        EXPECT_EQ(part_count(found[0]), 7);
        EXPECT_NEAR(found[0].plane.at, 0.5, 1e-12);
    }
}

/// What is infinitely far is of one plane too.
TEST(CoplanarMerging, TheSkyIsOne) {
    std::vector<TestLayer> layers;
    for (std::uint32_t part = 0; part < 64; ++part) {
        layers.push_back(layer_at({0, 0, 0}, part));
    }
    CoplanarMerging const merging = merging_of(layers);
    ASSERT_EQ(merging.coplanar().size(), 1u);
    EXPECT_EQ(merging.coplanar()[0].difference, 0);
}

/// Two layers far apart from each other cost less than what holds both.
TEST(CoplanarMerging, OnlyWhereThatIsCheaper) {
    std::vector<TestLayer> layers{layer_at({0.5, 0, 0}, 0), layer_at({0.5, 0, 0}, 63)};
    EXPECT_TRUE(several(merging_of(layers)).empty());
    std::vector<TestLayer> beside{layer_at({0.5, 0, 0}, 0), layer_at({0.5, 0, 0}, 1)};
    EXPECT_EQ(several(merging_of(beside)).size(), 1u);
}

/// A column of framelets grows piece by piece, past what is of another plane.
TEST(CoplanarMerging, WhatIsNearIsAddedUntilNothingIs) {
    std::vector<TestLayer> layers;
    for (std::uint32_t row = 0; row < 8; ++row) {
        std::uint32_t const part = morton_index(3, row);
        layers.push_back(layer_at({0.2, 0, 1e-4}, part));
        layers.push_back(layer_at({0.5, 0, 0}, part));
    }
    CoplanarMerging const merging = merging_of(layers);
    ASSERT_EQ(merging.coplanar().size(), 2u);
    EXPECT_EQ(part_count(merging.coplanar()[0]), 8);
    EXPECT_EQ(part_count(merging.coplanar()[1]), 8);
}

TEST(SquareLayers, MotionsAreNumbered) {
    SquareLayers square;
    HeldShape shape;
    shape.layer_count = 1;
    shape.layers[0].last_column = shape.layers[0].last_row = 3;
    std::uint32_t view = 0;
    std::uint32_t sets = 0;
    for (; square.set(sets % 64, view, 1, shape); ++sets) {
        view = sets;
    }
    EXPECT_GT(sets, 192u); // all layers that can be held at once
    EXPECT_LT(sets, 1000u);
    square.forget_motions();
    for (std::size_t index = 0; index < SquareLayers::most_framelets; ++index) {
        ASSERT_TRUE(square.set(index, 7 + static_cast<std::uint32_t>(index % 2), 1, shape));
    }
    EXPECT_EQ(square.motion(square.rows(0).motion[5]).view, 8u);
    EXPECT_EQ(square.rows(0).motion[5], square.rows(0).motion[7]);
    square.clear(5);
    EXPECT_EQ(square.rows(0).held, ~std::uint64_t{1u << 5});
}

} // namespace
} // namespace framelet
