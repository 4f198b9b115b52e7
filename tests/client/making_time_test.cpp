#include "client/core/picture/making_time.h"

#include <random>

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(MakingTime, FollowsWhatWasTaken) {
    MakingTime making;
    EXPECT_EQ(making.expected(), 0);
    for (int i = 0; i < 100; ++i) {
        making.note(0.02);
    }
    EXPECT_NEAR(making.expected(), 0.02, 1e-4) << "nothing is added where it is always the same";
}

TEST(MakingTime, IsEnoughForMostPictures) {
    MakingTime making;
    std::mt19937 random(1);
    std::normal_distribution<double> taken(0.02, 0.002);
    int late = 0;
    for (int i = 0; i < 1100; ++i) {
        double const seconds = taken(random);
        late += i >= 100 && seconds > making.expected() ? 1 : 0;
        making.note(seconds);
    }
    EXPECT_NEAR(making.expected(), 0.021, 0.003);
    EXPECT_NEAR(late, 370, 80);
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
