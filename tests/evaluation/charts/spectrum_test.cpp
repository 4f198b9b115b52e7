#include "tests/evaluation/charts/spectrum.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "common/error.h"

namespace framelet::bench {
namespace {

/// Grey picture of `value` in [0, 1], rounded to bytes.
Picture picture_of(int width, int height, std::function<double(int, int)> const& value) {
    Picture picture(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            auto const byte = static_cast<std::uint8_t>(std::lround(std::clamp(value(x, y), 0.0, 1.0) * 255));
            std::fill_n(picture.row(y) + static_cast<std::ptrdiff_t>(x) * 4, 4, byte);
        }
    }
    return picture;
}

/// A sum of waves of every direction, as many in each octave: the power in a ring falls with `slope`. Not made by a
/// transform, so that a mistake in ours cannot cancel.
Picture waves(int width, int height, double slope, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    struct Wave {
        double x, y, phase, amplitude;
    };
    constexpr int count = 1500;
    double const lowest = 1.0 / std::min(width, height);
    std::vector<Wave> all;
    double power = 0;
    for (int i = 0; i < count; ++i) {
        double const frequency = lowest * std::pow(0.5 / lowest, (i + uniform(random)) / count);
        double const angle = 2 * std::numbers::pi * uniform(random);
        // Waves an octave: constant; places in the frequency plane an octave: f^2.
        double const amplitude = std::pow(frequency, slope / 2 + 1);
        all.push_back({2 * std::numbers::pi * frequency * std::cos(angle),
                       2 * std::numbers::pi * frequency * std::sin(angle), 2 * std::numbers::pi * uniform(random),
                       amplitude});
        power += amplitude * amplitude / 2;
    }
    return picture_of(width, height, [&](int x, int y) {
        double sum = 0;
        for (Wave const& wave : all) {
            sum += wave.amplitude * std::cos(wave.x * x + wave.y * y + wave.phase);
        }
        return 0.5 + 0.15 * sum / std::sqrt(power);
    });
}

Picture white_noise(int width, int height, double deviation) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal(0.5, deviation);
    return picture_of(width, height, [&](int, int) { return normal(random); });
}

TEST(Spectrum, WhiteNoiseIsFlatAtItsVariance) {
    Picture const noise = white_noise(256, 192, 0.1);
    auto const spectrum = radial_power(noise);
    ASSERT_EQ(spectrum.size(), 96u);
    for (std::size_t i = 10; i < spectrum.size(); ++i) {
        EXPECT_NEAR(spectrum[i].power, 0.01, 0.005) << spectrum[i].frequency;
    }
    EXPECT_NEAR(power_spectrum_slope(noise), 0, 0.1);
}

TEST(Spectrum, KnownSlopesAreFound) {
    for (double const slope : {-1.0, -2.0, -3.0}) {
        EXPECT_NEAR(power_spectrum_slope(waves(128, 128, slope, 1)), slope, 0.2);
    }
    EXPECT_NEAR(power_spectrum_slope(waves(150, 101, -2, 2)), -2, 0.25);
}

TEST(Spectrum, AWaveStandsAtItsFrequency) {
    for (bool const upright : {false, true}) {
        Picture const wave = picture_of(120, 90, [&](int x, int y) {
            return 0.5 + 0.4 * std::sin(2 * std::numbers::pi * 0.2 * (upright ? x : y));
        });
        auto const spectrum = radial_power(wave);
        auto const peak = std::max_element(spectrum.begin(), spectrum.end(),
                                           [](auto const& a, auto const& b) { return a.power < b.power; });
        EXPECT_NEAR(peak->frequency, 0.2, 0.5 / 90);
    }
}

// The transform of a disc falls with f^-1.5, that of a straight edge with 1/f along one line of a ring of length f:
// both powers with f^-3.
TEST(Spectrum, OneEdgeFallsWithTheThirdPower) {
    Picture const disc = picture_of(
        256, 256, [](int x, int y) { return std::clamp(60.5 - std::hypot(x - 128.3, y - 127.6), 0.0, 1.0); });
    EXPECT_NEAR(power_spectrum_slope(disc), -3, 0.25);
    Picture const edge = picture_of(256, 256, [](int x, int) { return x < 120 ? 0.2 : 0.8; });
    EXPECT_NEAR(power_spectrum_slope(edge), -3, 0.25);
}

TEST(Spectrum, SmoothIsSteeperThanAnEdge) {
    Picture const smooth = picture_of(256, 256, [](int x, int y) {
        double const r = std::hypot(x - 128, y - 128) / 20;
        return 0.9 * std::exp(-r * r);
    });
    EXPECT_LT(power_spectrum_slope(smooth), -3.3);
}

TEST(Spectrum, FlatAndTinyPicturesHaveSlopeZero) {
    EXPECT_EQ(power_spectrum_slope(picture_of(100, 70, [](int, int) { return 0.3; })), 0);
    EXPECT_EQ(power_spectrum_slope(Picture(1, 1)), 0);
    EXPECT_EQ(power_spectrum_slope(Picture(500, 1)), 0);
    EXPECT_EQ(power_spectrum_slope(Picture()), 0);
    EXPECT_EQ(power_spectrum_slope(waves(19, 64, -2, 3)), 0);
    EXPECT_NE(power_spectrum_slope(waves(20, 64, -2, 3)), 0);
}

TEST(Spectrum, LineThroughExactPowersIsExact) {
    std::vector<SpectrumPoint> points;
    for (int i = 1; i <= 64; ++i) {
        double const f = i / 128.0;
        points.push_back({f, 0.02 * std::pow(f, -1.7)});
    }
    EXPECT_NEAR(log_log_slope(points), -1.7, 1e-12);
    points[0].power = points[1].power = points[40].power = 1e6; // outside the limits
    EXPECT_NEAR(log_log_slope(points), -1.7, 1e-12);
    EXPECT_EQ(log_log_slope({}), 0);
}

TEST(Spectrum, TemporalSlopes) {
    std::mt19937 random(5);
    std::normal_distribution<double> normal(0, 1);
    constexpr std::size_t side = 16;
    constexpr int times = 128, width = side;
    std::vector<Picture> noise, walk;
    std::vector<double> state(side * side, 0.5);
    for (int t = 0; t < times; ++t) {
        noise.push_back(picture_of(width, width, [&](int, int) { return 0.5 + 0.1 * normal(random); }));
        walk.push_back(picture_of(width, width, [&](int x, int y) {
            double& value = state[static_cast<std::size_t>(y) * side + static_cast<std::size_t>(x)];
            return value += 0.01 * normal(random);
        }));
    }
    EXPECT_NEAR(temporal_spectrum_slope(noise), 0, 0.1);
    EXPECT_NEAR(temporal_power(noise)[20].power, 0.01, 0.002);
    EXPECT_NEAR(temporal_spectrum_slope(walk), -2, 0.2); // white noise summed up
    EXPECT_EQ(temporal_spectrum_slope(std::vector<Picture>(40, noise[0])), 0);
    EXPECT_EQ(temporal_spectrum_slope(std::span(noise).first(1)), 0);
    EXPECT_EQ(temporal_spectrum_slope({}), 0);
}

TEST(Spectrum, SequencesOfTwoSizesAreRefused) {
    std::vector<Picture> const pictures{Picture(8, 8), Picture(8, 9)};
    EXPECT_THROW(temporal_power(pictures), InputError);
}

} // namespace
} // namespace framelet::bench
