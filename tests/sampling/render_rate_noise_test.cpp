#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "server/sampling/plan/render_rate.h"

namespace framelet {
namespace {

/// A recursive average of weight alpha keeps alpha / (2 - alpha) of the variance of what it is fed with. What is
/// averaged here is the time per sample, with alpha = 1 - exp(-seconds of a batch / memory).
TEST(RenderRate, KeepsTheVarianceThatItsWeightSays) {
    constexpr double memory_seconds = 0.25;
    for (double const alpha : {2.0 / 5, 2.0 / 9, 0.05}) {
        double const seconds = -memory_seconds * std::log(1 - alpha);
        std::mt19937 random(7);
        std::uniform_real_distribution<double> noise(0.5e-6, 1.5e-6); // seconds a sample
        constexpr double noise_variance = 1e-12 / 12;
        RenderRate rate;
        double sum = 0, squares = 0;
        constexpr int warm_up = 1000;
        constexpr int count = 200000;
        for (int i = -warm_up; i < count; ++i) {
            rate = update_render_rate(rate, seconds / noise(random), seconds);
            if (i >= 0) {
                double const estimate = 1 / rate.samples_per_second - 1e-6;
                sum += estimate;
                squares += estimate * estimate;
            }
        }
        double const mean = sum / count;
        EXPECT_NEAR(mean, 0, 0.01e-6);
        EXPECT_NEAR((squares / count - mean * mean) / noise_variance, alpha / (2 - alpha), 0.05 * alpha / (2 - alpha));
    }
}

} // namespace
} // namespace framelet
