#include "tests/evaluation/methods/response/variance_error.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "common/framelet/tile.h"

namespace framelet {
namespace {

using Samples = std::vector<float>;

constexpr RateTemplates templates{{-6.0f, 0.0f}, {-8.0f, 1.0f}};

RateError estimate(Samples const& samples, VarianceHistory& history, float seconds = template_interval) {
    RateError error;
    estimate_variance(samples, history, seconds, templates, {&error, 1});
    return error;
}

/// Samples of 0.5 + `swing` and 0.5 - `swing` in turn: their variance is the swing's square.
Samples alternating(float swing) {
    Samples samples(framelet_samples);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        samples[i] = 0.5f + (i % 2 == 0 ? swing : -swing);
    }
    return samples;
}

TEST(VarianceError, NothingThereIsRedundant) {
    VarianceHistory history;
    EXPECT_EQ(estimate(Samples(framelet_samples, 0.25f), history), (RateError{-1, 0}));
    EXPECT_EQ(estimate(Samples(framelet_samples, 0.25f), history), (RateError{-1, -1}));
}

TEST(VarianceError, IsZeroAtTheTemplate) {
    VarianceHistory history;
    EXPECT_NEAR(estimate(alternating(0.125f), history).space, 0, 1e-5); // 2^-6
    EXPECT_NEAR(estimate(alternating(0.1875f), history).time, 0, 1e-5); // the change by 2^-4 has energy 2^-8
    // The change of 2^-3 has energy 2^-6, two octaves on.
    EXPECT_NEAR(estimate(alternating(0.3125f), history, 4 * template_interval).time, 0, 1e-5);
}

TEST(VarianceError, SignedByWhichIsMore) {
    VarianceHistory history;
    EXPECT_NEAR(estimate(alternating(0.25f), history).space, 0.6f, 1e-5); // four times the template: 3/5
    EXPECT_NEAR(estimate(alternating(0.0625f), history).space, -0.6f, 1e-5);
    EXPECT_GT(estimate(alternating(0.25f), history).time, 0);
    EXPECT_EQ(estimate(alternating(0.25f), history).time, -1);
}

TEST(VarianceError, BlocksAreJudgedEachForItself) {
    Samples samples(framelet_samples, 0.5f);
    Samples const detail = alternating(0.25f);
    std::copy_n(detail.begin(), 64, samples.begin() + 128); // the lower left quarter
    for (std::size_t const count : {4u, 16u, 64u, 256u}) {
        VarianceHistory history;
        std::vector<RateError> elements(count);
        for (int round = 0; round < 2; ++round) {
            estimate_variance(samples, history, 1, templates, elements);
            for (std::size_t i = 0; i < count; ++i) {
                EXPECT_NEAR(elements[i].space, i * 4 / count == 2 ? 0.6f : -1, 1e-5) << count << " " << i;
                EXPECT_EQ(elements[i].time, round == 0 ? 0 : -1);
            }
        }
    }
}

} // namespace
} // namespace framelet
