#include "common/held/held_shape.h"

#include <gtest/gtest.h>

#include "common/color.h"

namespace framelet {
namespace {

/// Column x of a tile is red x; the left half lies on layer 0, the right half on layer 1, row 5 is outliers.
struct Mixed {
    DisplayFramelet framelet;
    FrameletShape shape;

    Mixed() {
        framelet.green.fill(40);
        framelet.blue.fill(50);
        shape.layer_count = 2;
        for (std::uint32_t i = 0; i < framelet_samples; ++i) {
            std::uint32_t const x = morton_x(i);
            framelet.red[i] = static_cast<std::uint8_t>(x);
            shape.layer_of[i] = x < 8 ? 0 : 1;
            if (morton_y(i) == 5) {
                shape.layer_of[i] = FrameletShape::outlier;
                shape.outliers.push_back({static_cast<float>(x + 1), 3, {}});
            }
        }
    }
};

TEST(HeldShape, SamplesAndLayersAreInRows) {
    Mixed const mixed;
    std::array<PackedSample, framelet_samples> samples;
    HeldShape held;
    hold(mixed.framelet, &mixed.shape, 1, samples, held);
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        std::uint32_t const x = i % 16;
        EXPECT_EQ(red_of(samples[i]), x);
        EXPECT_EQ(green_of(samples[i]), 40u);
        EXPECT_EQ(blue_of(samples[i]), 50u);
        EXPECT_EQ(layer_of(samples[i]), i / 16 == 5 ? FrameletShape::outlier : x / 8);
    }
    EXPECT_TRUE(held.moves);
    ASSERT_EQ(held.outliers.size(), 16u);
    for (std::size_t x = 0; x < 16; ++x) {
        EXPECT_EQ(held.outliers[x].index, 80 + x);
        EXPECT_EQ(held.outliers[x].sample.inverse_depth, static_cast<float>(x + 1));
    }
    EXPECT_EQ(held.layers[1].first_column, 8);
    EXPECT_EQ(held.layers[1].last_column, 15);
    EXPECT_EQ(held.layers[1].first_row, 0);
    EXPECT_EQ(held.layers[1].last_row, 15);
    EXPECT_LT(held.layers[2].last_column, held.layers[2].first_column);
}

TEST(HeldShape, FineSamplesAreReducedToTheLayerThatMostOfAPixelLieOn) {
    Mixed mixed;
    std::array<PackedSample, framelet_samples> samples;
    HeldShape held;
    hold(mixed.framelet, &mixed.shape, 4, samples, held);
    EXPECT_EQ(held.side, 4);
    EXPECT_TRUE(held.outliers.empty()); // a row of four of sixteen samples is not most
    for (std::uint32_t i = 0; i < 16; ++i) {
        EXPECT_EQ(layer_of(held.reduced[i]), i % 4 / 2);
        EXPECT_EQ(green_of(held.reduced[i]), 40u);
    }
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        if (mixed.shape.layer_of[i] != FrameletShape::outlier && morton_y(i) / 2 == 2) {
            mixed.shape.layer_of[i] = FrameletShape::outlier;
        }
        count += mixed.shape.layer_of[i] == FrameletShape::outlier ? 1 : 0;
    }
    mixed.shape.outliers.assign(count, {2, static_body, {}});
    mixed.shape.outliers.back().inverse_depth = 5;
    hold(mixed.framelet, &mixed.shape, 2, samples, held);
    EXPECT_EQ(held.side, 8);
    ASSERT_EQ(held.outliers.size(), 8u);
    EXPECT_EQ(held.outliers[0].index, 16);
    EXPECT_EQ(held.outliers[7].sample.inverse_depth, 5);
    EXPECT_FALSE(held.moves);
}

TEST(HeldShape, NoShapeIsInfinitelyFar) {
    std::array<PackedSample, framelet_samples> samples;
    HeldShape held;
    hold(Mixed().framelet, nullptr, 1, samples, held);
    EXPECT_EQ(held.layer_count, 1);
    EXPECT_EQ(held.layers[0].layer, Layer{});
    EXPECT_EQ(held.layers[0].last_row, 15);
    EXPECT_FALSE(held.moves);
}

/// Layer 1 is a board in front of layer 0; where both are at one depth neither ends.
TEST(HeldShape, WhatIsNearerEndsBeforeWhatIsBehindIt) {
    Mixed mixed;
    mixed.shape.layers[0].at = 0.1f;
    mixed.shape.layers[1].at = 0.2f;
    std::array<PackedSample, framelet_samples> samples;
    for (int const per_pixel : {1, 2}) {
        HeldShape held;
        hold(mixed.framelet, &mixed.shape, per_pixel, samples, held);
        find_ends(1, samples, held);
        EXPECT_EQ(held.layers[0].ends_before, 0);
        EXPECT_EQ(held.layers[1].ends_before, 1);
    }
    mixed.shape.layers[0].dx = 0.1f / 8; // they meet between the halves
    HeldShape held;
    hold(mixed.framelet, &mixed.shape, 1, samples, held);
    find_ends(1, samples, held);
    EXPECT_EQ(held.layers[0].ends_before, 0);
    EXPECT_EQ(held.layers[1].ends_before, 0);
}

} // namespace
} // namespace framelet
