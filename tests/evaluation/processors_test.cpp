// What a server with more processors comes to by what its stages take.
#include "tests/evaluation/processors.h"

#include <gtest/gtest.h>

namespace framelet::bench {
namespace {

TEST(StageCost, IsFoundByTwoCountsOrMore) {
    auto const seconds = [](double serial, double parallel, std::vector<int> const& threads) {
        std::vector<double> out;
        for (int const count : threads) {
            out.push_back(serial + parallel / count);
        }
        return out;
    };
    for (std::vector<int> const& threads : {std::vector{1, 2}, std::vector{4, 1}, std::vector{1, 2, 3, 64}}) {
        StageCost const cost = stage_cost(threads, seconds(3, 40, threads));
        EXPECT_NEAR(cost.serial, 3, 1e-9);
        EXPECT_NEAR(cost.parallel, 40, 1e-9);
    }
}

TEST(StageCost, NoPartIsBelowZero) {
    StageCost const faster = stage_cost({1, 2}, {10, 4});
    EXPECT_EQ(faster.serial, 0);
    EXPECT_GT(faster.parallel, 8);
    EXPECT_LT(faster.parallel, 10);
    StageCost const slower = stage_cost({1, 2}, {10, 12});
    EXPECT_EQ(slower.parallel, 0);
    EXPECT_EQ(slower.serial, 11);
}

TEST(ServerCosts, WithoutSerialWorkAllThreadsAreOfUse) {
    ServerCosts const costs{{0, 2}, {0, 400}, {0, 20}, {0, 10}};
    EXPECT_DOUBLE_EQ(seconds_with(costs, 1), 432);
    EXPECT_DOUBLE_EQ(seconds_with(costs, 32), 432.0 / 32);
}

TEST(ServerCosts, ABatchIsFinishedBesideTheNextOne) {
    ServerCosts const costs{{1, 0}, {0, 400}, {5, 0}, {3, 0}};
    EXPECT_DOUBLE_EQ(costs.serial(), 9);
    EXPECT_DOUBLE_EQ(seconds_with(costs, 1), 409);
    EXPECT_DOUBLE_EQ(seconds_with(costs, 8), 1 + 408.0 / 8);
    EXPECT_DOUBLE_EQ(seconds_with(costs, 1 << 20), 9) << "learning and encoding are one after the other";
}

} // namespace
} // namespace framelet::bench
