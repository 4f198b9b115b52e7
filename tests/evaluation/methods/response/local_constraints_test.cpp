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
}

TEST(LocalConstraints, StopsAtTheBoundTheRayPointsAt) {
    EXPECT_DOUBLE_EQ(respond_locally({1, 1}, {1, 0}, bounds, 100).change, 3);
    EXPECT_DOUBLE_EQ(respond_locally({1, 1}, {-1, 0}, bounds, 100).change, -0.75);
    EXPECT_DOUBLE_EQ(respond_locally({1, 1}, {0, 1}, bounds, 100).change, 7);
    EXPECT_DOUBLE_EQ(respond_locally({1, 1}, {0, -1}, bounds, 100).change, -0.5);
    EXPECT_DOUBLE_EQ(respond_locally({4, 8}, {1, 1}, bounds, 100).change, 0);
}

TEST(LocalConstraints, HoldForAnyState) {
    HardStates states(1);
    for (int i = 0; i < 200'000; ++i) {
        DensityBounds const limits = states.bounds();
        Density const at = states.density(limits);
        RateError const error = states.error();
        LocalResponse const response = respond_locally(at, error, limits, states.uniform(0, 2));
        ASSERT_TRUE(std::isfinite(response.change));
        double const slack = 1e-12 * at.area();
        ASSERT_LE(at.area() + response.change, limits.most.area() * (1 + 1e-12) + slack);
        ASSERT_GE(at.area() + response.change, limits.least.area() * (1 - 1e-12) - slack);
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
