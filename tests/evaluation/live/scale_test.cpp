// What a cluster comes to by the costs of a sample.
#include <gtest/gtest.h>

#include "tests/evaluation/live/scale.h"

namespace framelet::bench {
namespace {

TEST(Growth, FewWorkersAreAllOfUse) {
    Growth const found = growth({20e-6, 0.4e-6, 8e-9, 10e-9}, {1, 32, 1e10});
    EXPECT_DOUBLE_EQ(found.efficiency, 1);
    EXPECT_DOUBLE_EQ(found.samples_per_second, 32 / 20e-6);
    EXPECT_EQ(found.end, "the workers");
}

TEST(Growth, EachPartMayBeItsEnd) {
    constexpr WorkCosts cheap{1e-6, 0, 0, 0};
    auto const end = [](WorkCosts const& costs, double bits = 1e15) { return growth(costs, {100, 32, bits}).end; };
    EXPECT_EQ(end(cheap), "the workers");
    EXPECT_EQ(end({1e-6, 1e-6, 0, 0}), "the server's processors");
    EXPECT_EQ(end({1e-6, 0, 1e-6, 0}), "the thread of the connections");
    EXPECT_EQ(end({1e-6, 0, 0, 1e-6}), "the plan");
    EXPECT_EQ(end(cheap, 1e6), "the link");
    EXPECT_DOUBLE_EQ(growth(cheap, {100, 32, 8 * bytes_a_path}).samples_per_second, 1);
}

TEST(Growth, MoreWorkersNeverShowLess) {
    WorkCosts const costs{5e-6, 0.4e-6, 8e-9, 40e-9};
    double before = 0;
    for (int ranks = 1; ranks < 2000; ranks *= 2) {
        Growth const found = growth(costs, {ranks, 32, 1e10});
        EXPECT_GE(found.samples_per_second, before);
        EXPECT_LE(found.efficiency, 1);
        before = found.samples_per_second;
    }
}

} // namespace
} // namespace framelet::bench
