#include "server/sampling/held/coding_cost.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(CodingCost, IsHalfABitWhereNothingIsToBeSeen) {
    for (float const bits : coded_bits(0)) {
        EXPECT_FLOAT_EQ(bits, 0.5f);
    }
}

TEST(CodingCost, IsTheRateOfGaussianCoefficients) {
    // Three times the noise a pixel apart, four times with it: one bit for three of four coefficients, then half of
    // log2 of 7, 13 and 25 for the coarser octaves.
    LevelCosts const bits = coded_bits(3e-4f);
    float const coarser =
        0.5f * (0.1875f * std::log2(7.0f) + 0.046875f * std::log2(13.0f) + 0.01171875f * std::log2(25.0f));
    EXPECT_NEAR(bits[static_cast<std::size_t>(pixel_level)], 0.5f + 0.75f + coarser, 1e-5f);
}

TEST(CodingCost, IsFiniteAndGrowsWithDetail) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> exponent(-40, 3);
    for (int i = 0; i < 200'000; ++i) {
        float const detail = random() % 8 == 0 ? 0 : std::exp2(exponent(random));
        LevelCosts const before = coded_bits(detail);
        LevelCosts const after = coded_bits(2 * detail);
        for (std::size_t level = 0; level < before.size(); ++level) {
            ASSERT_TRUE(std::isfinite(after[level]));
            ASSERT_GE(before[level], 0.5f);
            ASSERT_GE(after[level], before[level]);
            ASSERT_LE(level > 0 ? before[level] : 0, before[level > 0 ? level - 1 : 0]) << "finer samples differ less";
        }
    }
}

} // namespace
} // namespace framelet
