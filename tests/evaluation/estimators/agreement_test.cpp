// Tests the judging of estimators: known correlations, and estimators whose agreement is known.
#include "tests/evaluation/estimators/agreement.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

namespace framelet::bench {
namespace {

TEST(Agreement, RankCorrelationByHand) {
    std::vector<double> const a{1, 2, 3, 4, 5}, b{10, 100, 1000, 1e4, 1e5}, down{5, 4, 3, 2, 1}, same(5, 7.0);
    EXPECT_DOUBLE_EQ(rank_correlation(a, b), 1);
    EXPECT_DOUBLE_EQ(rank_correlation(a, down), -1);
    EXPECT_EQ(rank_correlation(a, same), 0);
    EXPECT_DOUBLE_EQ(rank_correlation(a, std::vector<double>{2, 1, 4, 3, 5}), 0.8); // 1 - 6 * 4 / (5 * 24)
    EXPECT_NEAR(rank_correlation(a, std::vector<double>{1, 1, 2, 2, 2}), 0.866, 0.001); // ties share their mean rank
}

TEST(Agreement, CountsSignsByKindAndLeavesOutTheIdeal) {
    std::vector<Verdict> const verdicts{{0.5, 1, 0}, {-0.5, -1, 0}, {-0.1, 2, 0},
                                        {-1, -2, 1}, {-1, -3, 1},   {1, 0.1, 1}};
    SignAgreement const signs = sign_agreement(verdicts);
    EXPECT_DOUBLE_EQ(signs.all, 4.0 / 5);
    EXPECT_DOUBLE_EQ(signs.balanced, 0.75); // 1 of 2 undersampled, 3 of 3 redundant
}

TEST(Agreement, OfTheTruthIsPerfect) {
    std::vector<Verdict> verdicts;
    for (int i = -10; i <= 10; ++i) {
        verdicts.push_back({std::tanh(i * 0.3), static_cast<double>(i), i & 1});
    }
    Agreement const found = agreement(verdicts);
    EXPECT_DOUBLE_EQ(found.rank, 1);
    EXPECT_DOUBLE_EQ(found.rank_at_rate, 1);
    EXPECT_DOUBLE_EQ(found.signs.balanced, 1);
}

TEST(Agreement, OfTheRateAloneDoesNotTellPlacesApart) {
    std::vector<Verdict> verdicts; // verdicts whose ideal is rate 2 or 3
    for (int rate = 0; rate < 6; ++rate) {
        for (double const ideal : {2.0, 3.0}) {
            verdicts.push_back({0, ideal - rate, rate});
        }
    }
    Agreement const found = agreement_of_rate_alone(verdicts, RateOrder::ascending);
    EXPECT_DOUBLE_EQ(found.signs.all, 1);
    EXPECT_EQ(found.rank_at_rate, 0);
    EXPECT_GT(found.rank, 0.9);
}

/// Value noise: random values at the corners of cells, bilinear between them; smooth to a sampling denser than the
/// cells, noise to a sparser one.
double value_noise(double x, double y) {
    auto const corner = [](double column, double row) {
        auto hash = static_cast<std::uint32_t>(column) * 0x9e3779b9u ^ static_cast<std::uint32_t>(row) * 0x85ebca6bu;
        hash = (hash ^ (hash >> 15)) * 0x2c1b3c6du;
        hash = (hash ^ (hash >> 12)) * 0x297a2d39u;
        return (hash ^ (hash >> 15)) * 0x1p-32;
    };
    double const column = std::floor(x), row = std::floor(y);
    double const above = std::lerp(corner(column, row), corner(column + 1, row), x - column);
    double const below = std::lerp(corner(column, row + 1), corner(column + 1, row + 1), x - column);
    return std::lerp(above, below, y - row);
}

/// Places of such noise, which stands still, with cells an octave apart.
std::vector<Place> noises() {
    std::vector<Place> places;
    for (int i = 0; i < 12; ++i) {
        double const cells_per_pixel = 0.1 * (1 << (i % 6));
        Place place{{1u << 10}, 1, {cells_per_pixel / 2, 0}, std::vector<float>(observed_luma_size())};
        auto const write = [&](int ago, int level) {
            for (int index = 0; index < framelets_at(level); ++index) {
                auto const samples = observed_samples(place, ago, level, index);
                float* const luma = place.luma.data() + (samples.data() - place.luma.data());
                for (std::uint32_t s = 0; s < framelet_samples; ++s) {
                    double const scale = cells_per_pixel * spacing_at(level);
                    double const x = 1000 * i + morton_x(s) * scale, y = 100 * index + morton_y(s) * scale;
                    luma[s] = static_cast<float>(value_noise(x, y));
                }
            }
        };
        for (int level = 0; level < observed_levels; ++level) {
            for (int interval = 0; interval < observed_intervals; ++interval) {
                for (int refresh = 0; refresh < observed_refreshes; ++refresh) {
                    write(refresh << interval, level);
                }
            }
        }
        places.push_back(std::move(place));
    }
    return places;
}

TEST(Estimators, SomeHaarTemplateTellsScalesOfNoiseApart) {
    std::vector<Place> const places = noises();
    ErrorEstimator const& haar = error_estimators[0];
    double best = 0;
    for (float offset = -22; offset <= 0; ++offset) {
        for (float const slope : {0.0f, 0.5f, 1.0f, 2.0f}) {
            Verdicts const verdicts = judge(haar, {{offset, slope}, haar.templates.time}, places);
            best = std::max(best, agreement(verdicts.space).rank);
            // Nothing moves, so that every refresh is redundant, and must be judged so.
            EXPECT_EQ(sign_agreement(verdicts.time).all, 1);
        }
    }
    EXPECT_GT(best, 0.7);
}

} // namespace
} // namespace framelet::bench
