#include "server/stream/layers/plane_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace framelet {
namespace {

GridFloats values_of(GridPlane const& plane) {
    GridFloats values;
    for (int i = 0; i < framelet_samples; ++i) {
        values[i] = plane.centre + plane.dx * grid_coordinates.x[i] + plane.dy * grid_coordinates.y[i];
    }
    return values;
}

GridFloats where(auto const& takes_part) {
    GridFloats weights;
    for (int i = 0; i < framelet_samples; ++i) {
        weights[i] = takes_part(grid_coordinates.x[i], grid_coordinates.y[i]) ? 1.0f : 0.0f;
    }
    return weights;
}

void expect_near(GridPlane const& a, GridPlane const& b) {
    EXPECT_NEAR(a.centre, b.centre, 1e-5f);
    EXPECT_NEAR(a.dx, b.dx, 1e-6f);
    EXPECT_NEAR(a.dy, b.dy, 1e-6f);
}

TEST(PlaneFit, BlockOrderIsAPermutationWithBlocksAsLanes) {
    std::array<int, framelet_samples> seen{};
    for (int i = 0; i < framelet_samples; ++i) {
        ++seen[static_cast<std::size_t>(block_order(i))];
    }
    EXPECT_EQ(std::ranges::count(seen, 1), framelet_samples);
    EXPECT_EQ(grid_coordinates.x[block_order(0)], -7.5f);
    EXPECT_EQ(grid_coordinates.y[block_order(framelet_samples - 1)], 7.5f);
    EXPECT_EQ(block_order(block_samples), 1) << "first sample of the second block";
    std::array<float, framelet_samples> morton;
    std::iota(morton.begin(), morton.end(), 0.0f);
    GridFloats ordered;
    to_block_order(morton, ordered);
    for (int i = 0; i < framelet_samples; ++i) {
        EXPECT_EQ(ordered[block_order(i)], static_cast<float>(i));
    }
}

TEST(PlaneFit, FindsAPlaneFromAnyPartOfIt) {
    GridPlane const plane{0.4f, 0.003f, -0.011f};
    GridFloats const values = values_of(plane);
    expect_near(fit_plane_to_all(values).plane, plane);
    EXPECT_NEAR(fit_plane_to_all(values).half_width, 0, 1e-6f);
    expect_near(least_squares(moments_of(values, where([](float, float) { return true; }))), plane);
    expect_near(least_squares(moments_of(values, where([](float x, float y) { return x + 2 * y > 11; }))), plane);
    BlockMoments const blocks = block_moments_of(values, where([](float, float) { return true; }));
    expect_near(least_squares(blocks.total), plane);
    for (Moments const& block : blocks.block) {
        EXPECT_EQ(block.n, block_samples);
        expect_near(least_squares(block), plane);
    }
}

TEST(PlaneFit, SamplesOnALineGiveItsSlopeAlone) {
    GridFloats const values = values_of({1, 0.02f, 0.05f});
    GridPlane const row = least_squares(moments_of(values, where([](float, float y) { return y == 2.5f; })));
    EXPECT_NEAR(row.dx, 0.02f, 1e-6f);
    EXPECT_NEAR(row.dy, 0, 1e-6f);
    GridPlane const diagonal = least_squares(moments_of(values, where([](float x, float y) { return x == y; })));
    EXPECT_NEAR(diagonal.dx + diagonal.dy, 0.07f, 1e-6f);
    EXPECT_NEAR(diagonal.dx, diagonal.dy, 1e-6f);
    auto const one = where([](float x, float y) { return x == -3.5f && y == 0.5f; });
    GridPlane const point = least_squares(moments_of(values, one));
    EXPECT_EQ(point.dx, 0);
    EXPECT_EQ(point.dy, 0);
    EXPECT_NEAR(residual_range(values, one, point).most, 0, 1e-6f);
    EXPECT_EQ(least_squares({}).centre, 0);
}

TEST(PlaneFit, RangeAndMembersAgree) {
    std::mt19937 random(3);
    std::normal_distribution<float> noise;
    GridFloats values = values_of({2, 0.1f, 0});
    for (float& value : values.value) {
        value += noise(random);
    }
    GridFloats const weights = where([](float x, float) { return x > -4; });
    GridPlane const plane = least_squares(moments_of(values, weights));
    Range const range = residual_range(values, weights, plane);
    EXPECT_LT(range.least, 0);
    EXPECT_GT(range.most, 0);
    float const farthest = std::max(-range.least, range.most);
    GridFloats members;
    EXPECT_EQ(find_members(values, weights, plane, farthest, members), 12 * framelet_side);
    EXPECT_EQ(find_members(values, weights, plane, 0.999f * farthest, members), 12 * framelet_side - 1);
    auto const all = where([](float, float) { return true; });
    FittedPlane const fitted = fit_plane_to_all(values);
    Range const rest = residual_range(values, all, fitted.plane);
    EXPECT_NEAR(rest.middle(), 0, 1e-5f);
    EXPECT_NEAR(rest.half_width(), fitted.half_width, 1e-5f);
    EXPECT_EQ(residual_range(values, where([](float, float) { return false; }), plane).half_width(), 0);
    EXPECT_EQ(greatest(values), *std::max_element(values.value, values.value + framelet_samples));
}

} // namespace
} // namespace framelet
