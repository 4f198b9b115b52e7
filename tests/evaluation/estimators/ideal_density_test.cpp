// Tests the oracle where the answer is known.
#include "tests/evaluation/estimators/ideal_density.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace framelet::bench {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double rate = 120; // pictures per second

/// A volume of 16x16 pixels, four samples along each; `value` of x, y (pixels) and t (seconds).
SampleVolume volume_of(std::function<double(double, double, double)> const& value, int times = 64) {
    SampleVolume volume{64, times, 16, times / rate, {}};
    for (int t = 0; t < times; ++t) {
        for (int y = 0; y < volume.side; ++y) {
            for (int x = 0; x < volume.side; ++x) {
                volume.luma.push_back(static_cast<float>(value((x + 0.5) / 4, (y + 0.5) / 4, t / rate)));
            }
        }
    }
    return volume;
}

TEST(IdealDensity, AConstantNeedsNothing) {
    IdealDensity const ideal = ideal_density(volume_of([](auto, auto, auto) { return 0.3; }), {});
    EXPECT_EQ(ideal.space_frequency, 0);
    EXPECT_EQ(ideal.time_frequency, 0);
}

TEST(IdealDensity, OfAMovingWaveIsItsFrequencyAndThatTimesItsSpeed) {
    struct Wave {
        double frequency; ///< cycles per pixel
        double speed; ///< pixels per second
    };
    for (Wave const wave : {Wave{0.25, 60}, Wave{0.5, 40}, Wave{0.125, 200}, Wave{0.5, 90}}) {
        auto const moving = [&](double x, double, double t) {
            return 0.5 + 0.3 * std::sin(2 * pi * wave.frequency * (x - wave.speed * t));
        };
        IdealDensity const ideal = ideal_density(volume_of(moving), {});
        EXPECT_NEAR(ideal.space_frequency, wave.frequency, 1.0 / 32) << wave.frequency; // within a bin
        EXPECT_NEAR(ideal.time_frequency, wave.frequency * wave.speed, rate / 64) << wave.speed;
        EXPECT_NEAR(ideal.samples_per_pixel(), std::pow(2 * wave.frequency, 2), 0.25 * wave.frequency + 0.01);
    }
}

TEST(IdealDensity, DetailWithinAPixelDoesNotCountInTime) {
    auto const moving = [](double x, double, double t) { return 0.5 + 0.3 * std::sin(2 * pi * (x - 20 * t)); };
    IdealDensity const ideal = ideal_density(volume_of(moving), {});
    EXPECT_NEAR(ideal.space_frequency, 1, 1.0 / 32);
    EXPECT_EQ(ideal.time_frequency, 0);
}

TEST(IdealDensity, OfAWaveThatStandsIsZeroInTime) {
    auto const standing = [](double x, double y, double) { return 0.5 + 0.3 * std::sin(2 * pi * 0.5 * (x + y)); };
    IdealDensity const ideal = ideal_density(volume_of(standing), {});
    EXPECT_NEAR(ideal.space_frequency, 0.5, 0.1); // the band is a square: each axis counts; mirroring bends the wave
    EXPECT_EQ(ideal.time_frequency, 0);
}

TEST(IdealDensity, OfALampThatGoesOnIsZeroInSpaceAndHighInTime) {
    auto const lamp = [](double, double, double t) { return t < 0.25 ? 0.2 : 0.8; };
    auto const dawn = [](double, double, double t) { return 0.2 + t; };
    IdealDensity const sudden = ideal_density(volume_of(lamp), {});
    IdealDensity const slow = ideal_density(volume_of(dawn), {});
    EXPECT_EQ(sudden.space_frequency, 0);
    EXPECT_EQ(slow.space_frequency, 0);
    EXPECT_LE(slow.time_frequency, 2 * rate / 64); // within the window's main lobe
    EXPECT_GT(sudden.time_frequency, 2 * slow.time_frequency);
}

TEST(IdealDensity, OfNoiseIsTheWholeBand) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> value(0, 1);
    IdealDensity const ideal = ideal_density(volume_of([&](auto, auto, auto) { return value(random); }), {});
    EXPECT_NEAR(ideal.space_frequency, std::sqrt(0.95) * 2, 0.04); // energy grows as the band's area; Nyquist: 2
    EXPECT_NEAR(ideal.time_frequency, 0.95 * rate / 2, 1);
}

TEST(IdealDensity, GrowsWithTheShare) {
    auto const edge = [](double x, double, double t) { return x < 4 + 16 * t ? 0.2 : 0.8; };
    SampleVolume const volume = volume_of(edge);
    IdealDensity last;
    for (double const share : {0.5, 0.8, 0.9, 0.95, 0.99}) {
        IdealDensity const ideal = ideal_density(volume, {share, 0});
        EXPECT_GT(ideal.space_frequency, last.space_frequency) << share;
        EXPECT_GT(ideal.time_frequency, last.time_frequency) << share;
        last = ideal;
    }
}

TEST(IdealDensity, WhatIsBelowTheFloorDoesNotCount) {
    auto const faint = [](double x, double, double t) { return 0.5 + 0.001 * std::sin(2 * pi * (x - 20 * t)); };
    EXPECT_EQ(ideal_density(volume_of(faint), {}).space_frequency, 0);
    EXPECT_NEAR(ideal_density(volume_of(faint), {0.95, 0}).space_frequency, 1, 1.0 / 32);
}

} // namespace
} // namespace framelet::bench
