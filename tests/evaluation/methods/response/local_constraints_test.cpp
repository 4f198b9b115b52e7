#include "tests/evaluation/methods/response/local_constraints.h"

#include <gtest/gtest.h>

#include "tests/evaluation/methods/response/hard_states.h"

namespace framelet {
namespace {

constexpr DensityBounds bounds{{0.25, 0.5}, {4, 8}};

TEST(LocalConstraints, NoErrorAsksForNothing) {
    EXPECT_EQ(respond_locally({1, 1}, {0, 0}, bounds, 1), LocalResponse{});
}

TEST(LocalConstraints, StepIsProportionalToTheError) {
    // A 3-4-5 triangle: from (1, 1) by 0.5 along (0.6, 0.8) to (1.3, 1.4).
    LocalResponse const response = respond_locally({1, 1}, {0.3f, 0.4f}, bounds, 1);
    EXPECT_NEAR(response.direction.space, 0.6, 1e-7);
    EXPECT_NEAR(response.change, 1.3 * 1.4 - 1, 1e-7);
    // The ray meets the bound in space at k = 5, where time is 5.
    EXPECT_NEAR(response.limit, 4 * 5 - 1, 1e-5);
}

TEST(LocalConstraints, StopsAtTheBoundTheRayPointsAt) {
    EXPECT_DOUBLE_EQ(respond_locally({1, 1}, {1, 0}, bounds, 100).change, 3);
    EXPECT_DOUBLE_EQ(respond_locally({1, 1}, {-1, 0}, bounds, 100).change, -0.75);
    EXPECT_DOUBLE_EQ(respond_locally({1, 1}, {0, 1}, bounds, 100).change, 7);
    EXPECT_DOUBLE_EQ(respond_locally({1, 1}, {0, -1}, bounds, 100).change, -0.5);
    EXPECT_DOUBLE_EQ(respond_locally({4, 8}, {1, 1}, bounds, 100).change, 0);
}

TEST(LocalConstraints, OppositeSignsRiseAndFallAgain) {
    // Along (1, -1) / sqrt 2 from (1, 4) the area is greatest where both are 2.5, and 4 again at (4, 1).
    LocalResponse const rising = respond_locally({1, 4}, {1, -1}, bounds, 0.5);
    EXPECT_GT(rising.change, 0);
    EXPECT_NEAR(rising.limit, 6.25 - 4, 1e-12);
    LocalResponse const falling = respond_locally({3, 2}, {1, -1}, bounds, 0.5);
    EXPECT_LT(falling.change, 0);
    EXPECT_NEAR(falling.limit, 4 * 1 - 6, 1e-12);
}

TEST(LocalConstraints, HoldForAnyState) {
    HardStates states(1);
    for (int i = 0; i < 1'000'000; ++i) {
        DensityBounds const limits = states.bounds();
        Density const at = states.density(limits);
        RateError const error = states.error();
        LocalResponse const response = respond_locally(at, error, limits, states.uniform(0, 2));
        ASSERT_TRUE(std::isfinite(response.change) && std::isfinite(response.limit));
        ASSERT_TRUE(response.change == 0 || (response.change > 0) == (response.limit > 0));
        ASSERT_LE(std::abs(response.change), std::abs(response.limit));
        double const slack = 1e-12 * at.area();
        ASSERT_LE(at.area() + response.limit, limits.most.area() * (1 + 1e-12) + slack);
        ASSERT_GE(at.area() + response.limit, limits.least.area() * (1 - 1e-12) - slack);
        if (error.space >= 0 && error.time >= 0) {
            ASSERT_GE(response.change, 0);
        }
        if (error.space <= 0 && error.time <= 0) {
            ASSERT_LE(response.change, 0);
        }
    }
}

} // namespace
} // namespace framelet
