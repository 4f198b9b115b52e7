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

/// Expects 1000 pictures that take so many seconds on the average, a tenth of that more or less; returns how many were
/// late.
int count_late(double mean, MakingTime& making) {
    std::mt19937 random(1);
    std::normal_distribution<double> taken(mean, 0.1 * mean);
    int late = 0;
    for (int i = 0; i < 1100; ++i) {
        double const seconds = taken(random);
        late += i >= 100 && seconds > making.expected() ? 1 : 0;
        making.note(seconds);
    }
    return late;
}

TEST(MakingTime, IsEnoughForNearlyAllPictures) {
    MakingTime making;
    EXPECT_LE(count_late(0.02, making), 40);
    EXPECT_NEAR(making.expected(), 0.025, 0.003);
}

TEST(MakingTime, IsEnoughForMostPicturesWhereMoreWouldCostTooMany) {
    MakingTime making;
    EXPECT_NEAR(count_late(0.04, making), 370, 80);
    EXPECT_NEAR(making.expected(), 0.042, 0.005);
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
