#include "client/making_time.h"

#include <random>

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(MakingTime, FollowsWhatWasTaken) {
    MakingTime making;
    EXPECT_EQ(making.expected(), 0);
    std::mt19937 random(1);
    std::normal_distribution<double> taken(0.02, 0.002);
    int late = 0;
    for (int i = 0; i < 1000; ++i) {
        double const seconds = taken(random);
        late += i >= 100 && seconds > making.expected() ? 1 : 0;
        making.note(seconds);
    }
    EXPECT_NEAR(making.expected(), 0.02, 0.003);
    EXPECT_NEAR(late, 450, 100) << "as often too late as too early";
}

TEST(MakingTime, AHiccupDoesNotStay) {
    MakingTime making;
    making.note(1000);
    EXPECT_LE(making.expected(), 0.1);
    for (int i = 0; i < 50; ++i) {
        making.note(0.01);
    }
    EXPECT_NEAR(making.expected(), 0.01, 0.001);
}

} // namespace
} // namespace framelet
