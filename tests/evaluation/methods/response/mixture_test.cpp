#include "tests/evaluation/methods/response/mixture.h"

#include <gtest/gtest.h>

#include "tests/evaluation/methods/response/hard_states.h"
#include "tests/evaluation/methods/response/local_constraints.h"

namespace framelet {
namespace {

constexpr DensityBounds bounds{{0.25, 0.5}, {4, 8}};

TEST(Mixture, MeetsTheCurveOnTheRay) {
    Density const to = mix({1, 1}, {0.6, 0.8}, 1.3 * 1.4 - 1, bounds);
    EXPECT_NEAR(to.space, 1.3, 1e-12);
    EXPECT_NEAR(to.time, 1.4, 1e-12);
    EXPECT_NEAR(mix({1, 1}, {1, 0}, 0.5, bounds).space, 1.5, 1e-12);
    EXPECT_NEAR(mix({1, 1}, {0, -1}, -0.25, bounds).time, 0.75, 1e-12);
}

TEST(Mixture, TakesTheFirstOfTwoMeetings) {
    // The ray from (1, 4) along (1, -1) has area 5.25 at (1.5, 3.5) and again at (3.5, 1.5).
    Density const to = mix({1, 4}, {std::sqrt(0.5), -std::sqrt(0.5)}, 1.25, bounds);
    EXPECT_NEAR(to.space, 1.5, 1e-12);
    EXPECT_NEAR(to.time, 3.5, 1e-12);
}

TEST(Mixture, NoChangeStays) {
    EXPECT_EQ(mix({1, 3}, {0.6, 0.8}, 0, bounds), (Density{1, 3}));
}

TEST(Mixture, DoesNotCancelNearAnAxis) {
    for (double const tiny : {1e-7, 1e-12, 1e-17, 1e-30, 1e-300}) {
        Density const to = mix({1, 1}, {1, tiny}, 1e-9, bounds);
        EXPECT_NEAR(to.space - 1, 1e-9, 1e-15) << tiny;
        EXPECT_NEAR(to.area(), 1 + 1e-9, 1e-15) << tiny;
    }
}

TEST(Mixture, SlidesOnTheCurveUpToTheBounds) {
    Density const to = slide({1, 2}, 1, bounds);
    EXPECT_DOUBLE_EQ(to.space, 2);
    EXPECT_DOUBLE_EQ(to.time, 1);
    EXPECT_DOUBLE_EQ(slide({1, 2}, 9, bounds).space, 4);
    EXPECT_DOUBLE_EQ(slide({1, 2}, 9, bounds).time, 0.5);
    EXPECT_DOUBLE_EQ(slide({1, 2}, -9, bounds).time, 8);
    EXPECT_EQ(slide({1, 2}, 0, bounds), (Density{1, 2}));
}

TEST(Mixture, HoldsForAnyState) {
    HardStates states(3);
    for (int i = 0; i < 200'000; ++i) {
        DensityBounds const limits = states.bounds();
        Density const at = states.density(limits);
        LocalResponse const local = respond_locally(at, states.error(), limits, states.uniform(0, 2));
        double const change = local.change * std::min(1.0, states.uniform(0, 1.3));
        Density const to = mix(at, local.direction, change, limits);
        ASSERT_TRUE(is_within(to, limits)) << i;
        ASSERT_NEAR(to.area(), at.area() + change, 1e-12 * std::max(at.area(), to.area())) << i;
        Density const biased = slide(to, states.uniform(-2, 2), limits);
        ASSERT_TRUE(is_within(biased, limits)) << i;
        ASSERT_NEAR(biased.area(), to.area(), 1e-12 * to.area()) << i;
    }
}

} // namespace
} // namespace framelet
