#include "server/sampling/model/coding_cost.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(CodingCost, IsHalfABitWhereNothingIsToBeSeen) {
    RegionModel flat;
    for (float const bits : coded_bits(flat)) {
        EXPECT_FLOAT_EQ(bits, 0.5f);
    }
}

TEST(CodingCost, IsTheRateOfGaussianCoefficients) {
    RegionModel region;
    region.energy[pixel_level] = 3e-4f; // four times the noise with it: one bit for three of four coefficients
    LevelCosts const bits = coded_bits(region);
    auto const pixel = static_cast<std::size_t>(pixel_level);
    EXPECT_FLOAT_EQ(bits[pixel - 1], 0.5f);
    EXPECT_FLOAT_EQ(bits[pixel], 0.5f + 0.75f);
    EXPECT_FLOAT_EQ(bits[pixel + 1], 0.5f + 0.75f / 4) << "of finer samples it is the second octave";
}

TEST(CodingCost, IsFiniteAndGrowsWithDetail) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> exponent(-40, 3);
    for (int i = 0; i < 200'000; ++i) {
        RegionModel region;
        for (float& energy : region.energy) {
            energy = random() % 8 == 0 ? 0 : std::exp2(exponent(random));
        }
        LevelCosts const before = coded_bits(region);
        region.energy[random() % region.energy.size()] *= 2;
        LevelCosts const after = coded_bits(region);
        for (std::size_t level = 0; level < before.size(); ++level) {
            ASSERT_TRUE(std::isfinite(after[level]));
            ASSERT_GE(before[level], 0.5f);
            ASSERT_GE(after[level], before[level]);
        }
    }
}

} // namespace
} // namespace framelet
