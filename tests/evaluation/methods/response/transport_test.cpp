#include "tests/evaluation/methods/response/transport.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "tests/evaluation/methods/response/hard_states.h"

namespace framelet {
namespace {

constexpr std::array strategies{Transport::shrink_larger, Transport::grow_smaller, Transport::fill_smaller};

struct Problem {
    std::vector<double> changes, limits;
};

std::vector<double> solve(Problem const& problem, Transport strategy, Surplus& surplus) {
    std::vector<double> changes = problem.changes;
    TransportScratch scratch;
    transport(changes, problem.limits, strategy, surplus, scratch);
    return changes;
}

std::vector<double> solve(Problem const& problem, Transport strategy) {
    Surplus none;
    return solve(problem, strategy, none);
}

double sum(std::vector<double> const& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

void expect_near(std::vector<double> const& found, std::vector<double> const& expected) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_NEAR(found[i], expected[i], 1e-12) << i;
    }
}

TEST(Transport, ShrinksTheLargerSide) {
    expect_near(solve({{1, 2, -4, -8}, {9, 9, -9, -9}}, Transport::shrink_larger), {1, 2, -1, -2});
    expect_near(solve({{8, 4, -2, -1}, {9, 9, -9, -9}}, Transport::shrink_larger), {2, 1, -2, -1});
}

TEST(Transport, GrowsTheSmallerSideToItsTightestLimit) {
    // The positive side has weight 2, because of the first element: 6 of the 12 that are asked back.
    expect_near(solve({{1, 2, -4, -8}, {2, 9, -9, -9}}, Transport::grow_smaller), {2, 4, -2, -4});
    // One element at its limit holds all others back: point e is point b.
    expect_near(solve({{1, 2, -4, -8}, {1, 9, -9, -9}}, Transport::grow_smaller), {1, 2, -1, -2});
}

TEST(Transport, FillsEachElementUpToItsOwnLimit) {
    // The first element stays at its limit, the other one takes the rest.
    expect_near(solve({{1, 2, -4, -3}, {1, 9, -9, -9}}, Transport::fill_smaller), {1, 6, -4, -3});
    // Even all limits together do not reach what is asked: the larger side shrinks.
    expect_near(solve({{1, 2, -4, -8}, {1, 5, -9, -9}}, Transport::fill_smaller), {1, 5, -2, -4});
    // Elements are cut in the order of their own weights: limits at 1.5, 3 and 10 times the change; the common weight
    // is 4.
    expect_near(solve({{2, 1, 1, -10}, {3, 3, 10, -10}}, Transport::fill_smaller), {3, 3, 4, -10});
}

TEST(Transport, ThreePercentAtTheirLimitsDoNotHoldTheOthersBack) {
    Problem problem;
    for (int i = 0; i < 1000; ++i) {
        problem.changes.push_back(1);
        problem.limits.push_back(i % 33 == 0 ? 1 : 10);
        problem.changes.push_back(-4);
        problem.limits.push_back(-4);
    }
    auto const moved = [&](Transport strategy) {
        double total = 0;
        for (double const change : solve(problem, strategy)) {
            total += std::abs(change);
        }
        return total;
    };
    EXPECT_NEAR(moved(Transport::grow_smaller), 2000, 1e-9);
    EXPECT_NEAR(moved(Transport::fill_smaller), 8000, 1e-9);
}

TEST(Transport, OneSideAloneDoesNotMove) {
    for (Transport const strategy : strategies) {
        EXPECT_EQ(sum(solve({{1, 2, 3}, {4, 4, 4}}, strategy)), 0);
        EXPECT_EQ(sum(solve({{-1, -2}, {-4, -4}}, strategy)), 0);
        EXPECT_EQ(solve({{}, {}}, strategy).size(), 0u);
        EXPECT_EQ(solve({{0, 0}, {0, 0}}, strategy), (std::vector<double>{0, 0}));
    }
}

TEST(Transport, SavesAndSpendsButNeverOwes) {
    for (Transport const strategy : strategies) {
        Surplus surplus{0, 5};
        EXPECT_DOUBLE_EQ(sum(solve({{-1, -2}, {-1, -2}}, strategy, surplus)), -3);
        EXPECT_DOUBLE_EQ(surplus.saved, 3);
        EXPECT_DOUBLE_EQ(sum(solve({{-1, -3}, {-1, -3}}, strategy, surplus)), -2) << "the account is full";
        EXPECT_DOUBLE_EQ(surplus.saved, 5);
        EXPECT_DOUBLE_EQ(sum(solve({{4}, {4}}, strategy, surplus)), 4);
        EXPECT_DOUBLE_EQ(sum(solve({{4}, {4}}, strategy, surplus)), 1);
        EXPECT_DOUBLE_EQ(surplus.saved, 0);
        EXPECT_DOUBLE_EQ(sum(solve({{4}, {4}}, strategy, surplus)), 0);
    }
}

TEST(Transport, HoldsForAnyChanges) {
    HardStates states(2);
    for (int round = 0; round < 20'000; ++round) {
        Problem problem;
        std::size_t const kind = states.below(5);
        for (std::size_t i = 0, count = 1 + states.below(60); i < count; ++i) {
            double const size = states.below(8) == 0 ? std::exp2(states.uniform(-1060, 300)) : states.uniform(0, 1);
            bool const negative = kind == 0 ? true : kind == 1 ? false : states.below(2) == 0;
            double const change = states.below(10) == 0 ? 0 : negative ? -size : size;
            problem.changes.push_back(change);
            double const reach = states.below(3) == 0 ? 1 : states.below(3) == 0 ? 1e30 : states.uniform(1, 20);
            problem.limits.push_back(change * reach);
        }
        for (Transport const strategy : strategies) {
            double const most = states.below(2) == 0 ? 0 : states.uniform(0, 10);
            Surplus surplus{states.uniform(0, 1) * most, most};
            double const saved = surplus.saved;
            auto const changes = solve(problem, strategy, surplus);
            double const magnitude = std::accumulate(changes.begin(), changes.end(), most,
                                                     [](double all, double change) { return all + std::abs(change); });
            for (std::size_t i = 0; i < changes.size(); ++i) {
                ASSERT_TRUE(std::isfinite(changes[i]));
                ASSERT_LE(std::abs(changes[i]), std::abs(problem.limits[i]));
                ASSERT_TRUE(changes[i] == 0 || (changes[i] > 0) == (problem.changes[i] > 0));
            }
            ASSERT_GE(surplus.saved, 0);
            ASSERT_LE(surplus.saved, most);
            ASSERT_LE(sum(changes), saved + 1e-12 * magnitude);
            ASSERT_NEAR(saved - sum(changes), surplus.saved, 1e-12 * magnitude);
        }
    }
}

} // namespace
} // namespace framelet
