// Tests the three stages together, cycle after cycle.
#include "tests/evaluation/methods/response/density_response.h"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "tests/evaluation/methods/response/hard_states.h"

namespace framelet {
namespace {

constexpr DensityBounds bounds{{1.0 / 64, 0.625}, {16, 80}};
constexpr double rate_unit = 10;

/// A field and all that the response needs for it.
struct Loop {
    Loop() {
        elements.resize(density.size());
        std::iota(elements.begin(), elements.end(), 0u);
    }

    void step(std::vector<RateError> const& errors) { respond(density, elements, errors, parameters, scratch); }
    bool is_sound() const {
        for (std::size_t i = 0; i < density.size(); ++i) {
            if (!is_within({density.space[i], density.time[i]}, bounds)) {
                return false;
            }
        }
        return true;
    }

    DensityField density = make_uniform_density(2, {1, rate_unit});
    std::vector<std::uint32_t> elements;
    ResponseParameters parameters{bounds, 0.1, rate_unit, 0};
    ResponseScratch scratch;
};

std::vector<RateError> errors_of(HardStates& states, std::size_t count) {
    std::vector<RateError> errors(count);
    for (RateError& error : errors) {
        error = states.below(3) == 0 ? RateError{} : states.error();
    }
    return errors;
}

TEST(DensityResponse, ZeroErrorChangesNothing) {
    Loop loop;
    loop.parameters.bias = 0.5;
    DensityField const before = loop.density;
    loop.step(std::vector<RateError>(loop.density.size()));
    EXPECT_EQ(loop.density, before);
}

TEST(DensityResponse, OnlyTheElementsNamedChange) {
    Loop loop;
    loop.elements = {3, 9};
    DensityField const before = loop.density;
    loop.step({{1, 0}, {0, -1}});
    for (std::uint32_t i = 0; i < before.size(); ++i) {
        bool const named = i == 3 || i == 9;
        EXPECT_EQ(loop.density.space[i] != before.space[i] || loop.density.time[i] != before.time[i], named) << i;
    }
    EXPECT_GT(loop.density.space[3], 1);
    EXPECT_LT(loop.density.time[9], rate_unit);
}

TEST(DensityResponse, IsConservedAndBoundedFor100000Cycles) {
    HardStates states(4);
    Loop loop;
    double const budget = combined_density(loop.density);
    for (int cycle = 0; cycle < 100'000; ++cycle) {
        loop.parameters.gain = states.uniform(0, 0.5);
        loop.parameters.bias = states.uniform(-0.1, 0.1);
        loop.step(errors_of(states, loop.density.size()));
        ASSERT_TRUE(loop.is_sound()) << cycle;
    }
    EXPECT_NEAR(combined_density(loop.density), budget, 1e-6 * budget);
}

TEST(DensityResponse, TheSignOfTheChangeIsTheSignAsked) {
    HardStates states(6);
    for (int round = 0; round < 30'000; ++round) {
        Loop loop;
        for (std::size_t i = 0; i < loop.density.size(); ++i) {
            Density const at = states.density(bounds);
            loop.density.space[i] = at.space;
            loop.density.time[i] = at.time;
        }
        auto const errors = errors_of(states, loop.density.size());
        DensityField const before = loop.density;
        loop.step(errors);
        for (std::size_t i = 0; i < errors.size(); ++i) {
            double const was = before.space[i] * before.time[i];
            double const asked = respond_locally({before.space[i], before.time[i] / rate_unit}, errors[i],
                                                 {{bounds.least.space, bounds.least.time / rate_unit},
                                                  {bounds.most.space, bounds.most.time / rate_unit}},
                                                 0.1)
                                     .change;
            double const change = loop.density.space[i] * loop.density.time[i] - was;
            ASSERT_GE(change * (asked > 0 ? 1 : asked < 0 ? -1 : 0), -1e-12 * was) << round << ' ' << i;
        }
    }
}

TEST(DensityResponse, ConstantErrorsComeToRest) {
    // Without bias each element moves along one direction only, so it must come to rest: here after 3000 cycles no
    // density moves by more than 1e-6 of its range in a cycle.
    HardStates states(7);
    for (int round = 0; round < 40; ++round) {
        Loop loop;
        auto const errors = errors_of(states, loop.density.size());
        for (int cycle = 0; cycle < 3000; ++cycle) {
            loop.step(errors);
        }
        DensityField const before = loop.density;
        loop.step(errors);
        for (std::size_t i = 0; i < before.size(); ++i) {
            EXPECT_NEAR(loop.density.space[i], before.space[i], 1e-6 * bounds.most.space);
            EXPECT_NEAR(loop.density.time[i], before.time[i], 1e-6 * bounds.most.time);
        }
    }
}

/// Largest distances from an affordable ideal in the last 200 of 2000 cycles, where errors fall to 0 as it is reached.
Density hunting() {
    Loop loop;
    auto const ideal = [](std::size_t i) { return Density{i % 2 == 0 ? 1.75 : 0.25, rate_unit}; };
    std::vector<RateError> errors(loop.density.size());
    Density worst;
    for (int cycle = 0; cycle < 2000; ++cycle) {
        for (std::size_t i = 0; i < errors.size(); ++i) {
            errors[i] = {static_cast<float>(std::tanh(std::log(ideal(i).space / loop.density.space[i]))),
                         static_cast<float>(std::tanh(std::log(ideal(i).time / loop.density.time[i])))};
            if (cycle >= 1800) {
                worst.space = std::max(worst.space, std::abs(loop.density.space[i] - ideal(i).space));
                worst.time = std::max(worst.time, std::abs(loop.density.time[i] - ideal(i).time));
            }
        }
        loop.step(errors);
    }
    return worst;
}

TEST(DensityResponse, StaysWithinAStepOfAnIdealThatItCanAfford) {
    Density const worst = hunting();
    EXPECT_LT(worst.space, 0.1); // the gain
    EXPECT_LT(worst.time, 0.1 * rate_unit);
}

} // namespace
} // namespace framelet
