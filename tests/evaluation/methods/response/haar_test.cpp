#include "tests/evaluation/methods/response/haar.h"

#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/evaluation/methods/response/haar_inverse.h"

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
        for (std::size_t octave = 0; octave < framelet_octaves; ++octave) {
            energy += double(octave_energy(samples, octave, 0, framelet_samples));
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
        for (std::uint32_t other = 0; other < framelet_octaves; ++other) {
            EXPECT_EQ(octave_energy(samples, other, 0, framelet_samples), other == octave ? 0.25f : 0.0f);
        }
    }
}

/// The energy of a part is, in octaves within it, that of its own blocks; in coarser ones, that of the block that it
/// lies in.
TEST(Haar, EnergiesOfPartsAverageToThatOfTheWhole) {
    Samples samples = random_samples(1);
    haar_forward(samples);
    for (std::size_t octave = 0; octave < framelet_octaves; ++octave) {
        for (std::size_t const count : {1u, 4u, 16u, 64u, 256u}) {
            float sum = 0;
            for (std::size_t first = 0; first < samples.size(); first += count) {
                sum += octave_energy(samples, octave, first, count);
            }
            float const mean = sum * static_cast<float>(count) / framelet_samples;
            EXPECT_NEAR(mean, octave_energy(samples, octave, 0, framelet_samples), 1e-6) << octave << ' ' << count;
        }
    }
}

} // namespace
} // namespace framelet
