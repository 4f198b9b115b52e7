#include "tests/evaluation/methods/response/haar_error.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "tests/evaluation/methods/response/haar.h"
#include "tests/evaluation/methods/response/haar_inverse.h"

namespace framelet {
namespace {

using Samples = std::vector<float>;

constexpr RateTemplates templates{{-12.0f, 0.25f}, {-14.0f, -0.5f}};

Samples make_samples(std::uint32_t side, std::function<float(std::uint32_t, std::uint32_t)> const& value) {
    Samples samples(side * side);
    for (std::uint32_t i = 0; i < side * side; ++i) {
        samples[i] = value(morton_x(i), morton_y(i));
    }
    return samples;
}

Samples constant(float value) {
    return Samples(framelet_samples, value);
}

Samples noise(unsigned seed, std::size_t count = framelet_samples) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(0, 1);
    Samples samples(count);
    std::generate(samples.begin(), samples.end(), [&] { return value(random); });
    return samples;
}

RateError estimate(Samples const& samples, HaarHistory& history, float seconds = template_interval) {
    RateError error;
    estimate_haar(samples, history, seconds, templates, {&error, 1});
    return error;
}

/// Weight of an octave: 8, 4, 2 and 1 of 15.
float weight(std::size_t octave) {
    return static_cast<float>(8 >> octave) / 15;
}

float difference(float energy, EnergyTemplate const& line, float octave) {
    float const allowed = std::exp2(line.offset + line.slope * octave);
    return (energy - allowed) / (energy + allowed);
}

TEST(HaarError, NothingThereIsRedundant) {
    HaarHistory history;
    EXPECT_EQ(estimate(constant(0.5f), history), (RateError{-1, 0}));
    EXPECT_EQ(estimate(constant(0.5f), history), (RateError{-1, -1}));
}

TEST(HaarError, NoiseIsUndersampledInSpaceAndWhereItChangesInTime) {
    HaarHistory history;
    EXPECT_GT(estimate(noise(1), history).space, 0.5f);
    RateError const still = estimate(noise(1), history);
    EXPECT_GT(still.space, 0.5f);
    EXPECT_EQ(still.time, -1);
    EXPECT_GT(estimate(noise(2), history).time, 0.3f);
}

TEST(HaarError, ALampThatGoesOnIsChangeInTimeOnly) {
    HaarHistory history;
    estimate(constant(0.1f), history);
    RateError const error = estimate(constant(0.9f), history);
    EXPECT_EQ(error.space, -1);
    EXPECT_GT(error.time, 0.9f);
}

TEST(HaarError, ComparesTheEnergiesOfTheOctavesWithTheTemplate) {
    Samples const samples = noise(3);
    Samples coefficients = samples;
    haar_forward(coefficients);
    std::span<float const, framelet_samples> const whole(coefficients);
    float expected = 0;
    for (std::size_t octave = 0; octave < framelet_octaves; ++octave) {
        expected +=
            difference(octave_energy(whole, octave, 0, framelet_samples), templates.space, static_cast<float>(octave)) *
            weight(octave);
    }
    HaarHistory history;
    EXPECT_NEAR(estimate(samples, history).space, expected, 1e-5);
}

// Each octave passes on the mean of the new and of the cached: the new framelet's part halves from one octave to the
// next.
TEST(HaarError, IsTheTransformInThreeDimensions) {
    Samples before = noise(4), after = noise(5);
    HaarHistory history;
    estimate(before, history);
    float const seconds = 4 * template_interval;
    RateError const found = estimate(after, history, seconds);
    haar_forward(before);
    haar_forward(after);
    RateError expected;
    float part = 0.5f;
    for (std::size_t octave = 0; octave < framelet_octaves; ++octave, part *= 0.5f) {
        std::size_t const stride = std::size_t(1) << (2 * octave);
        float space = 0, time = 0;
        // The low pass of this octave: hh of each block, from the coefficients of all coarser octaves.
        Samples low_before, low_after;
        for (std::size_t i = 0; i < before.size(); i += 4 * stride) {
            for (std::size_t band = 1; band < 4; ++band) {
                float const mean = part * after[i + band * stride] + (1 - part) * before[i + band * stride];
                space += mean * mean;
            }
            for (std::size_t band = 1; band < 3; ++band) {
                float const change = part * (after[i + band * stride] - before[i + band * stride]);
                time += change * change;
            }
            low_before.push_back(before[i]);
            low_after.push_back(after[i]);
        }
        haar_inverse(low_before);
        haar_inverse(low_after);
        for (std::size_t i = 0; i < low_after.size(); ++i) {
            float const change = part * (low_after[i] - low_before[i]);
            time += change * change;
        }
        auto const blocks = static_cast<float>(low_after.size());
        auto const line = static_cast<float>(octave);
        expected.space += difference(space / blocks, templates.space, line) * weight(octave);
        expected.time += difference(time / blocks, templates.time, line + 2) * weight(octave); // 2^2 intervals apart
    }
    EXPECT_NEAR(found.space, expected.space, 1e-4);
    EXPECT_NEAR(found.time, expected.time, 1e-4);
}

TEST(HaarError, BlocksAreJudgedEachForItself) {
    Samples samples = constant(0.5f);
    Samples const detail = noise(6);
    std::copy_n(detail.begin(), 64, samples.begin() + 128); // the lower left quarter
    for (std::size_t const count : {4u, 16u, 64u, 256u}) {
        HaarHistory history;
        std::vector<RateError> elements(count);
        estimate_haar(samples, history, 1, templates, elements);
        float inside = 2, outside = -2;
        for (std::size_t i = 0; i < count; ++i) {
            bool const detailed = i * 4 / count == 2;
            (detailed ? inside : outside) =
                detailed ? std::min(inside, elements[i].space) : std::max(outside, elements[i].space);
        }
        // Outside there is only the share in the coarsest octave.
        EXPECT_LE(outside, -0.5f) << count;
        EXPECT_GT(inside, outside + 0.3f) << count;
    }
}

TEST(HaarError, WhatIsTheSameEverywhereIsTheSameInEveryBlock) {
    for (std::uint32_t const side : {16u, 32u}) {
        Samples const checks = make_samples(side, [](auto x, auto y) { return (x + y) % 2 == 0 ? 0.6f : 0.4f; });
        HaarHistory whole_history;
        RateError whole;
        estimate_haar(checks, whole_history, 1, templates, {&whole, 1});
        for (std::size_t const count : {4u, 16u, 64u, 256u}) {
            HaarHistory history;
            std::vector<RateError> elements(count);
            estimate_haar(checks, history, 1, templates, elements);
            for (RateError const& element : elements) {
                EXPECT_NEAR(element.space, whole.space, 1e-6) << side << " " << count;
            }
        }
    }
}

TEST(HaarError, StaysWithinItsBounds) {
    for (unsigned seed = 0; seed < 200; ++seed) {
        HaarHistory history;
        std::size_t const count = seed % 2 == 0 ? 256 : 1024;
        for (unsigned step = 0; step < 3; ++step) {
            std::vector<RateError> elements(std::size_t(1) << (2 * (seed % 5)));
            Samples samples = noise(seed * 3 + step, count);
            std::transform(samples.begin(), samples.end(), samples.begin(),
                           [&](float v) { return seed % 3 == 0 ? std::round(v) : v; });
            estimate_haar(samples, history, 1e-4f * static_cast<float>(1 + seed * seed), templates, elements);
            for (RateError const& element : elements) {
                EXPECT_LE(std::abs(element.space), 1);
                EXPECT_LE(std::abs(element.time), 1);
            }
        }
    }
}

} // namespace
} // namespace framelet
