#include "server/response/haar.h"

#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace framelet {
namespace {

using Samples = std::array<float, framelet_samples>;

Samples random_samples(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(0, 1);
    Samples samples;
    for (float& sample : samples) {
        sample = value(random);
    }
    return samples;
}

TEST(Haar, OneBlockByHand) {
    std::vector<float> block{1, 3, 5, 9}; // upper left, upper right, lower left, lower right
    haar_forward(block);
    EXPECT_EQ(block, (std::vector<float>{4.5f, -1.5f, -2.5f, 0.5f}));
}

TEST(Haar, InverseRestores) {
    for (std::size_t const count : {std::size_t{1}, std::size_t{4}, std::size_t{256}, std::size_t{1024}}) {
        std::mt19937 random(3);
        std::vector<float> samples(count);
        for (float& sample : samples) {
            sample = static_cast<float>(random() % 1024); // sums of these are exact
        }
        std::vector<float> restored = samples;
        haar_forward(restored);
        haar_inverse(restored);
        EXPECT_EQ(restored, samples) << count;
    }
}

TEST(Haar, EnergiesAddUpToTheMeanSquare) {
    for (unsigned seed = 0; seed < 100; ++seed) {
        Samples samples = random_samples(seed);
        double square = 0;
        for (float const sample : samples) {
            square += double(sample) * sample / framelet_samples;
        }
        haar_forward(samples);
        double energy = double(samples[0]) * samples[0];
        for (float const octave : octave_energies(samples)) {
            energy += octave;
        }
        EXPECT_NEAR(energy, square, 1e-5);
    }
}

TEST(Haar, ACheckerboardIsAllInItsOctave) {
    for (std::uint32_t octave = 0; octave < framelet_octaves; ++octave) {
        Samples samples;
        for (std::uint32_t i = 0; i < framelet_samples; ++i) {
            samples[i] = ((morton_x(i) >> octave) + (morton_y(i) >> octave)) % 2 == 0 ? 1.0f : 0.0f;
        }
        haar_forward(samples);
        EXPECT_FLOAT_EQ(samples[0], 0.5f);
        OctaveEnergies expected{};
        expected[octave] = 0.25f;
        EXPECT_EQ(octave_energies(samples), expected);
    }
}

TEST(Haar, DifferencesAreTheEnergiesOfTheDifference) {
    Samples a = random_samples(1);
    Samples b = random_samples(2);
    Samples difference;
    for (std::size_t i = 0; i < a.size(); ++i) {
        difference[i] = a[i] - b[i];
    }
    haar_forward(a);
    haar_forward(b);
    haar_forward(difference);
    OctaveDifferences const found = octave_differences(a, b);
    OctaveEnergies const expected = octave_energies(difference);
    for (std::size_t octave = 0; octave < framelet_octaves; ++octave) {
        EXPECT_NEAR(found.octaves[octave], expected[octave], 1e-6);
    }
    EXPECT_NEAR(found.mean, difference[0] * difference[0], 1e-6);
}

TEST(Haar, OctaveOfAnIndex) {
    EXPECT_EQ(haar_octave(1), 0u);
    EXPECT_EQ(haar_octave(3), 0u);
    EXPECT_EQ(haar_octave(8), 1u);
    EXPECT_EQ(haar_octave(192), 3u);
    EXPECT_EQ(haar_octave(193), 0u);
}

} // namespace
} // namespace framelet
