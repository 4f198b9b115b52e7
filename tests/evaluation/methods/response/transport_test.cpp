#include "tests/evaluation/methods/response/transport.h"

#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "tests/evaluation/methods/response/hard_states.h"

namespace framelet {
namespace {

std::vector<double> balanced(std::vector<double> changes) {
    transport(changes);
    return changes;
}

TEST(Transport, ShrinksTheLargerSide) {
    EXPECT_EQ(balanced({1, 2, -4, -8}), (std::vector<double>{1, 2, -1, -2}));
    EXPECT_EQ(balanced({8, 4, -2, -1}), (std::vector<double>{2, 1, -2, -1}));
}

TEST(Transport, OneSideAloneDoesNotMove) {
    EXPECT_EQ(balanced({1, 2, 3}), (std::vector<double>{0, 0, 0}));
    EXPECT_EQ(balanced({-1, -2}), (std::vector<double>{0, 0}));
    EXPECT_EQ(balanced({0, 0}), (std::vector<double>{0, 0}));
    EXPECT_EQ(balanced({}).size(), 0u);
}

TEST(Transport, HoldsForAnyChanges) {
    HardStates states(2);
    for (int round = 0; round < 20'000; ++round) {
        std::vector<double> asked;
        std::size_t const kind = states.below(5);
        for (std::size_t i = 0, count = 1 + states.below(60); i < count; ++i) {
            // Wide, but such that the quotient of two sums is a normal number.
            double const size = states.below(8) == 0 ? std::exp2(states.uniform(-600, 300)) : states.uniform(0, 1);
            bool const negative = kind == 0 ? true : kind == 1 ? false : states.below(2) == 0;
            asked.push_back(states.below(10) == 0 ? 0 : negative ? -size : size);
        }
        std::vector<double> const changes = balanced(asked);
        double sum = 0, magnitude = 0;
        for (std::size_t i = 0; i < changes.size(); ++i) {
            ASSERT_TRUE(std::isfinite(changes[i]));
            ASSERT_LE(std::abs(changes[i]), std::abs(asked[i]));
            ASSERT_GE(changes[i] * asked[i], 0);
            sum += changes[i];
            magnitude += std::abs(changes[i]);
        }
        ASSERT_NEAR(sum, 0, 1e-12 * magnitude);
    }
}

} // namespace
} // namespace framelet
