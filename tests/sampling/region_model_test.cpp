#include "server/sampling/model/region_model.h"

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "common/morton.h"

namespace framelet {
namespace {

using Samples = std::array<float, framelet_samples>;

Samples coefficients_of(std::function<float(std::uint32_t x, std::uint32_t y)> const& value) {
    Samples samples;
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        samples[i] = value(morton_x(i), morton_y(i));
    }
    haar_forward(samples);
    return samples;
}

/// Black and white blocks of 2^octave samples: energy 1/4.
Samples checkerboard(unsigned octave) {
    return coefficients_of(
        [octave](auto x, auto y) { return static_cast<float>(((x >> octave) + (y >> octave)) % 2); });
}

RegionModel random_region(std::mt19937& random) {
    std::uniform_real_distribution<float> exponent(-20, -1);
    RegionModel region = unknown_region();
    for (float& band : region.energy) {
        band = std::exp2(exponent(random));
    }
    return region;
}

bool is_sound(RegionModel const& region) {
    for (float const band : region.energy) {
        if (!(band >= 0) || !std::isfinite(band)) {
            return false;
        }
    }
    return region.motion >= 0 && std::isfinite(region.motion);
}

TEST(RegionModel, AnOctaveOfALevelIsItsBand) {
    for (int level = 0; level < sampling_levels; ++level) {
        for (unsigned octave = 0; octave < framelet_octaves; ++octave) {
            for (std::size_t const count : {4u, 16u, 64u, 256u}) {
                RegionModel region = unknown_region();
                learn(region, observe(level, checkerboard(octave), std::nullopt, 0, 256 - count, count));
                EXPECT_EQ(region.finest_seen, level);
                int const band = std::max(level - static_cast<int>(octave), 0);
                for (int b = std::max(level - 3, 0); b <= level; ++b) {
                    EXPECT_NEAR(region.energy[static_cast<std::size_t>(b)], b == band ? 0.25f : 0, 1e-5f)
                        << "level " << level << " octave " << octave << " band " << b << " of " << count;
                }
                for (auto b = static_cast<std::size_t>(level) + 1; b < sampling_levels; ++b) {
                    EXPECT_LE(region.energy[b], region.energy[b - 1]) << "unseen bands fall off";
                    EXPECT_GT(region.energy[b], 0);
                }
            }
        }
    }
}

/// A ramp's energy falls by 4 from an octave to the next finer one: that of steps of s in x is (s / 2)^2 at octave 0.
TEST(RegionModel, ARampIsMostlyCoarse) {
    float const slope = 1.0f / 16;
    Samples const ramp = coefficients_of([slope](auto x, auto) { return slope * static_cast<float>(x); });
    for (int level = 3; level < sampling_levels; ++level) {
        RegionModel region = unknown_region();
        learn(region, observe(level, ramp, std::nullopt, 0, 0, framelet_samples));
        for (int octave = 0; octave < 4; ++octave) {
            EXPECT_NEAR(region.energy[static_cast<std::size_t>(level - octave)],
                        0.25f * slope * slope * std::exp2(2.0f * static_cast<float>(octave)), 1e-5f);
        }
    }
}

/// Finer bands that were seen follow the finest of a coarser observation, by at most 4; what is sampled is not missing.
TEST(RegionModel, CarriesFinerBandsAlong) {
    RegionModel region = unknown_region();
    learn(region, observe(5, checkerboard(0), std::nullopt, 0, 0, 256));
    RegionModel const before = region;
    Samples const half = coefficients_of([](auto x, auto y) { return 0.5f * static_cast<float>((x + y) % 2); });
    learn(region, observe(3, half, std::nullopt, 0, 0, 256));
    EXPECT_EQ(region.finest_seen, 5);
    EXPECT_NEAR(region.energy[3], 0.0625f, 1e-5f);
    EXPECT_GE(region.energy[5], before.energy[5] / 4.0f);
    EXPECT_LE(region.energy[5], before.energy[5] * 4.0f);
}

TEST(RegionModel, FinerSamplingLeavesLess) {
    for (int level = 1; level < sampling_levels; ++level) {
        EXPECT_LT(unresolved_error(unknown_region(), level), unresolved_error(unknown_region(), level - 1));
    }
}

TEST(RegionModel, DriftErrorGrowsFromZeroToItsBound) {
    std::mt19937 random(1);
    for (int n = 0; n < 1000; ++n) {
        RegionModel const region = random_region(random);
        for (int level = 0; level < sampling_levels; ++level) {
            DriftBounds const bounds = drift_bounds(region, level);
            EXPECT_EQ(drift_error(region, level, 0), 0);
            float last = 0;
            for (float drift = 1e-4f; drift < 1e3f; drift *= 1.7f) {
                float const error = drift_error(region, level, drift);
                EXPECT_GE(error, last * (1 - 1e-6f));
                EXPECT_LE(error, bounds.most * (1 + 1e-5f));
                EXPECT_LE(error, bounds.growth * drift * 1.01f + 1e-9f);
                last = error;
            }
            EXPECT_NEAR(last, bounds.most, 1e-4f * bounds.most);
            float const little = 1e-2f;
            EXPECT_NEAR(drift_error(region, level, little), bounds.growth * little, 0.05f * bounds.growth * little);
        }
    }
}

TEST(RegionModel, DriftOfErrorIsTheInverse) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> exponent(-8, 4);
    for (int n = 0; n < 20000; ++n) {
        RegionModel region = random_region(random);
        int const level = static_cast<int>(random() % sampling_levels);
        float const drift = std::exp2(exponent(random));
        float const error = drift_error(region, level, drift);
        RegionModel const before = region;
        float const found = drift_of_error(region, level, error);
        EXPECT_NEAR(drift_error(region, level, found), error, 0.01f * error);
        if (error <= 0.9f * drift_bounds(before, level).most) {
            EXPECT_EQ(region, before);
            EXPECT_NEAR(found, drift, 0.01f * drift);
        }
    }
    RegionModel region = random_region(random);
    EXPECT_EQ(drift_of_error(region, 3, 0), 0);
}

TEST(RegionModel, ErrorThatTheBandsCannotHoldRaisesBandZero) {
    for (float const error : {0.01f, 0.1f, 0.5f, 1.0f}) {
        RegionModel region = unknown_region();
        region.energy.fill(1e-6f);
        RegionModel const before = region;
        float const drift = drift_of_error(region, 3, error);
        EXPECT_GT(region.energy[0], before.energy[0]);
        for (std::size_t band = 1; band < sampling_levels; ++band) {
            EXPECT_EQ(region.energy[band], before.energy[band]);
        }
        EXPECT_NEAR(drift_error(region, 3, drift), error, 0.01f * error);
        EXPECT_GE(drift_bounds(region, 3).most, error);
    }
}

/// A million observations, the half of them nonsense.
TEST(RegionModel, LearnsNothingUnsound) {
    std::mt19937 random(3);
    float const odd[] = {0,
                         1e-45f,
                         1e-38f,
                         1e-30f,
                         1e-6f,
                         1,
                         1e30f,
                         std::numeric_limits<float>::max(),
                         std::numeric_limits<float>::min()};
    std::uniform_real_distribution<float> exponent(-30, 2);
    auto const value = [&] { return random() % 4 == 0 ? odd[random() % std::size(odd)] : std::exp2(exponent(random)); };
    RegionModel region = unknown_region();
    for (int n = 0; n < 1000000; ++n) {
        Observation seen;
        seen.level = static_cast<int>(random() % sampling_levels);
        seen.has_change = random() % 2 == 0;
        for (std::size_t octave = 0; octave < framelet_octaves; ++octave) {
            seen.energy[octave] = value();
            seen.change[octave] = random() % 2 == 0 ? value() : 0;
        }
        seen.mean_change = value();
        seen.seconds = value();
        RegionModel const before = region;
        learn(region, seen);
        ASSERT_TRUE(is_sound(region)) << "observation " << n << ", seconds " << seen.seconds << ", motion before "
                                      << before.motion << ", after " << region.motion;
        ASSERT_TRUE(std::isfinite(unresolved_error(region, seen.level)));
        if (n % 16 == 0) {
            region = random_region(random);
        }
    }
}

TEST(RegionModel, NoChangeIsNoMotion) {
    Samples const luma = checkerboard(1);
    Samples const none{};
    RegionModel region = unknown_region();
    region.motion = 5;
    learn(region, observe(3, luma, std::span<float const, framelet_samples>(none), 0.1f, 0, 256));
    EXPECT_EQ(region.motion, 0);
    region.motion = 5;
    learn(region, observe(3, luma, std::nullopt, 0, 0, 256));
    EXPECT_EQ(region.motion, 5) << "nothing to compare with says nothing";
}

/// Random texture (white noise of cells of a pixel, seen through a tent) that moves at v pixels a second, seen again
/// when it has moved by half a pixel, one and two: the motion learnt a second is v times one constant, within a factor.
TEST(RegionModel, MotionIsProportionalToSpeed) {
    std::mt19937 random(4);
    std::vector<float> noise(64 * 64);
    for (float& cell : noise) {
        cell = static_cast<float>(random() % 1000) / 1000;
    }
    auto const texture = [&](float x, float y) {
        auto const at = [&](int column, int row) {
            return noise[static_cast<std::size_t>((row & 63) * 64 + (column & 63))];
        };
        int const column = static_cast<int>(std::floor(x));
        int const row = static_cast<int>(std::floor(y));
        float const u = x - static_cast<float>(column);
        float const v = y - static_cast<float>(row);
        return (1 - v) * ((1 - u) * at(column, row) + u * at(column + 1, row)) +
               v * ((1 - u) * at(column, row + 1) + u * at(column + 1, row + 1));
    };
    float least = 1e9f;
    float most = 0;
    for (float const speed : {1.0f, 10.0f, 100.0f}) {
        for (float const moved : {0.5f, 1.0f, 1.5f}) {
            float sum = 0;
            constexpr int tries = 20;
            for (int n = 0; n < tries; ++n) {
                auto const left = static_cast<float>(random() % 64);
                Samples samples;
                Samples change;
                for (std::uint32_t i = 0; i < framelet_samples; ++i) {
                    float const x = left + static_cast<float>(morton_x(i));
                    auto const y = static_cast<float>(morton_y(i));
                    samples[i] = texture(x - moved, y);
                    change[i] = samples[i] - texture(x, y);
                }
                haar_forward(samples);
                haar_forward(change);
                RegionModel region = unknown_region();
                Observation const seen = observe(pixel_level, samples, std::span<float const, framelet_samples>(change),
                                                 moved / speed, 0, 256);
                for (int i = 0; i < 10; ++i) { // the same again and again
                    learn(region, seen);
                }
                sum += region.motion / tries;
            }
            least = std::min(least, sum / speed);
            most = std::max(most, sum / speed);
        }
    }
    std::printf("motion / (pixels a second): %.2f .. %.2f\n", least, most);
    EXPECT_GT(least, 1);
    EXPECT_LT(most, 10);
    EXPECT_LT(most / least, 5);
}

} // namespace
} // namespace framelet
