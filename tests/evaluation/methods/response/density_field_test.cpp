#include "tests/evaluation/methods/response/density_field.h"

#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace framelet {
namespace {

std::vector<double> random_values(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> value(0.1, 10);
    std::vector<double> values(count);
    std::generate(values.begin(), values.end(), [&] { return value(random); });
    return values;
}

double mean(std::vector<double> const& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST(DensityField, UniformHasTheIntegralItIsMadeOf) {
    DensityField const field = make_uniform_density(3, {0.5, 4});
    EXPECT_EQ(field.size(), 64u);
    EXPECT_DOUBLE_EQ(combined_density(field), 128);
}

TEST(DensityField, ResamplingKeepsTheIntegral) {
    auto const field = random_values(256, 1);
    for (int depth = 0; depth <= 6; ++depth) {
        auto const other = resample_field(field, depth);
        EXPECT_EQ(other.size(), std::size_t(1) << (2 * depth));
        EXPECT_NEAR(mean(other), mean(field), 1e-12);
    }
    auto const back = resample_field(resample_field(field, 6), 4);
    for (std::size_t i = 0; i < field.size(); ++i) {
        EXPECT_DOUBLE_EQ(back[i], field[i]) << "copied up and averaged down again";
    }
    std::vector<double> const four{1, 2, 3, 6};
    EXPECT_EQ(resample_field(four, 0), (std::vector<double>{3}));
    EXPECT_EQ(resample_field(four, 2)[4], 2) << "Morton order";
}

/// The tiling of [Stephens 2011] fig. 4.3, in depth-first order.
std::vector<Tile> const tiling{{4}, {20}, {21}, {88}, {89}, {90}, {91}, {23}, {24}, {25}, {26}, {27}, {7}};

double integral(std::vector<double> const& values) {
    double sum = 0;
    for (std::size_t i = 0; i < tiling.size(); ++i) {
        sum += values[i] / static_cast<double>(std::size_t(1) << (2 * tiling[i].depth()));
    }
    return sum;
}

TEST(DensityField, TilingAndFieldKeepTheIntegralBothWays) {
    for (int depth = 0; depth <= 5; ++depth) {
        auto const field = random_values(std::size_t(1) << (2 * depth), 2);
        std::vector<double> values(tiling.size());
        tiles_from_field(tiling, field, values);
        EXPECT_NEAR(integral(values), mean(field), 1e-12) << depth;
        auto const own = random_values(tiling.size(), 3);
        auto written = field;
        if (depth > 0) { // at depth 0 all tiles share one element, so that none can be written alone
            field_from_tiles(tiling, own, written);
            EXPECT_NEAR(mean(written), integral(own), 1e-12) << depth;
        }
    }
}

TEST(DensityField, AFieldAtLeastAsFineKeepsEveryTilesValue) {
    auto const own = random_values(tiling.size(), 4);
    std::vector<double> field(64), values(tiling.size());
    field_from_tiles(tiling, own, field);
    tiles_from_field(tiling, field, values);
    for (std::size_t i = 0; i < tiling.size(); ++i) {
        EXPECT_NEAR(values[i], own[i], 1e-14);
    }
}

TEST(DensityField, ElementsThatNoTileTouchesStay) {
    std::vector<double> field(16, 7.0);
    std::vector<Tile> const some{{5}, {24}};
    field_from_tiles(some, std::vector<double>{1, 2}, field);
    EXPECT_EQ(field, (std::vector<double>{7, 7, 7, 7, 1, 1, 1, 1, 2, 7, 7, 7, 7, 7, 7, 7}));
}

} // namespace
} // namespace framelet
