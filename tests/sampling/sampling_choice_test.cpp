#include "server/sampling/model/sampling_choice.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace framelet {
namespace {

struct State {
    RegionModel region;
    float life = 1;
    SamplingPrice price;
};

State random_state(std::mt19937& random) {
    auto const between = [&random](float low, float high) {
        return std::exp2(std::uniform_real_distribution<float>(std::log2(low), std::log2(high))(random));
    };
    State state;
    state.region = unknown_region();
    for (float& band : state.region.energy) {
        band = between(1e-6f, 0.2f);
    }
    state.region.motion = random() % 5 == 0 ? 0 : between(0.01f, 100);
    state.life = between(0.1f, 4);
    state.price = {between(1e-9f, 1e-1f), between(0.001f, 0.3f), 0.02f, 0};
    return state;
}

SamplingChoice choose(State const& state, int least = 0, int most = sampling_levels - 1) {
    return choose_sampling(state.region, state.life, state.price, least, most, equal_costs);
}

/// The value that the header says is minimised.
double paid(State const& state, int level, double period) {
    DriftBounds const bounds = drift_bounds(state.region, level);
    double const rate = double(state.region.motion) * bounds.growth / bounds.most;
    double const left = bounds.most * std::exp(-rate * state.price.latency);
    double const x = rate * period;
    double const kept = x > 1e-6 ? -std::expm1(-x) / x : 1;
    return unresolved_error(state.region, level) + bounds.most - left * kept +
           double(state.price.price) * samples_per_pixel(level) / period;
}

double samples_a_second(SamplingChoice const& choice) {
    return double(samples_per_pixel(choice.level)) / choice.period;
}

TEST(SamplingChoice, IsTheMinimum) {
    std::mt19937 random(1);
    double worst = 0;
    for (int n = 0; n < 2000; ++n) {
        State const state = random_state(random);
        SamplingChoice const choice = choose(state);
        double least = 1e9;
        double const longest = std::max(state.life, state.price.least_period);
        for (int level = 0; level < sampling_levels; ++level) {
            for (double period = state.price.least_period; period < longest * 1.01; period *= 1.01) {
                least = std::min(least, paid(state, level, std::min(period, longest)));
            }
        }
        double const found = paid(state, choice.level, choice.period);
        worst = std::max(worst, found / least - 1);
        EXPECT_LE(found, 1.02 * least) << n;
        EXPECT_NEAR(choice.due_error, found, 0.02 * found + 1e-7); // floats
    }
    std::printf("worst choice: %.4f above the minimum\n", worst);
}

/// A minimum of error + price * rate over all pairs of level and period cannot ask for more at a higher price; the
/// period's table may blur that by the share below.
TEST(SamplingChoice, AHigherPriceNeverAsksForMore) {
    std::mt19937 random(2);
    for (int n = 0; n < 5000; ++n) {
        State state = random_state(random);
        double last = 1e30;
        for (state.price.price = 1e-9f; state.price.price < 10; state.price.price *= 1.5f) {
            double const asked = samples_a_second(choose(state));
            ASSERT_LE(asked, last * 1.02) << n << " at " << state.price.price;
            last = asked;
        }
    }
}

TEST(SamplingChoice, StaysWithinItsBounds) {
    std::mt19937 random(3);
    for (int n = 0; n < 100000; ++n) {
        State state = random_state(random);
        int const least = static_cast<int>(random() % sampling_levels);
        int const most = least + static_cast<int>(random() % static_cast<unsigned>(sampling_levels - least));
        state.price.bias = std::uniform_real_distribution<float>(-1, 1)(random);
        SamplingChoice const choice = choose(state, least, most);
        ASSERT_GE(choice.level, least);
        ASSERT_LE(choice.level, most);
        ASSERT_GE(choice.period, state.price.least_period);
        ASSERT_LE(choice.period, std::max(state.life, state.price.least_period));
    }
}

TEST(SamplingChoice, BiasTradesSpaceForTime) {
    std::mt19937 random(4);
    int finer = 0;
    int oftener = 0;
    for (int n = 0; n < 20000; ++n) {
        State state = random_state(random);
        state.price.bias = -1;
        SamplingChoice const spatial = choose(state);
        state.price.bias = 1;
        SamplingChoice const temporal = choose(state);
        ASSERT_LE(temporal.level, spatial.level) << n;
        if (temporal.level == spatial.level) {
            ASSERT_LE(temporal.period, spatial.period * 1.001f) << n;
        }
        finer += spatial.level > temporal.level ? 1 : 0;
        oftener += temporal.period < spatial.period * 0.999f ? 1 : 0;
    }
    EXPECT_GT(finer, 5000);
    EXPECT_GT(oftener, 5000);
}

/// `due_error` is compared with the error that a region shows, which knows no bias: what has just been rendered as
/// chosen is not due, and at the chosen age it is.
TEST(SamplingChoice, IsDueAtItsPeriodWhateverTheBias) {
    std::mt19937 random(5);
    for (int n = 0; n < 20000; ++n) {
        State state = random_state(random);
        state.price.bias = std::uniform_real_distribution<float>(-1, 1)(random);
        SamplingChoice const choice = choose(state);
        DriftBounds const bounds = drift_bounds(state.region, choice.level);
        double const rate = double(state.region.motion) * bounds.growth / bounds.most;
        auto const shown = [&](double age) {
            return unresolved_error(state.region, choice.level) - bounds.most * std::expm1(-rate * age);
        };
        ASSERT_GE(choice.due_error, shown(state.price.latency) * 0.999) << n;
        if (choice.period > state.price.least_period * 1.01f && choice.period < state.life * 0.99f) {
            ASSERT_NEAR(choice.due_error, shown(state.price.latency + choice.period), 0.02 * choice.due_error) << n;
        }
    }
}

TEST(SamplingChoice, IsFiniteForAnything) {
    std::mt19937 random(6);
    float const odd[] = {0, 1e-45f, 1e-30f, 1e-6f, 1, 64, 1e6f, 1e30f};
    auto const value = [&] { return odd[random() % std::size(odd)]; };
    for (int n = 0; n < 1000000; ++n) {
        State state;
        for (float& band : state.region.energy) {
            band = std::clamp(value(), 1e-6f, 4.0f); // as `learn` keeps them
        }
        state.region.motion = value();
        state.life = value();
        state.price = {value(), value(), std::max(value(), 1e-6f), static_cast<float>(random() % 3) - 1};
        SamplingChoice const choice = choose(state);
        ASSERT_TRUE(std::isfinite(choice.period) && choice.period > 0) << n;
        ASSERT_TRUE(std::isfinite(choice.due_error) && choice.due_error >= 0)
            << n << " motion " << state.region.motion << " life " << state.life << " price " << state.price.price
            << " latency " << state.price.latency << " least " << state.price.least_period;
    }
}

} // namespace
} // namespace framelet
