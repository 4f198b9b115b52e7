#include "tests/evaluation/codecs/simulated_link.h"

#include <gtest/gtest.h>

namespace framelet::bench {
namespace {

TEST(SimulatedLink, RateAndDelayAddUp) {
    LinkParameters parameters;
    parameters.bits_per_second = 8e6;
    parameters.delay_seconds = 0.05;
    SimulatedLink link(parameters);
    auto const first = link.send(1, 100'000);
    EXPECT_NEAR(first.departed, 1.1, 1e-12);
    EXPECT_NEAR(first.arrived, 1.15, 1e-12);
    EXPECT_NEAR(link.backlog_seconds(1.04), 0.06, 1e-12);
    auto const second = link.send(1.05, 100'000);
    EXPECT_NEAR(second.departed, 1.2, 1e-12) << "waits for the first";
    EXPECT_NEAR(link.backlog_seconds(2), 0, 1e-12);
    EXPECT_NEAR(link.send(3, 0).arrived, 3.05, 1e-12);
}

TEST(SimulatedLink, UnlimitedTakesOnlyItsDelay) {
    LinkParameters parameters;
    parameters.delay_seconds = 0.01;
    SimulatedLink link(parameters);
    EXPECT_NEAR(link.send(-2, 1'000'000'000).arrived, -1.99, 1e-12);
    EXPECT_NEAR(link.backlog_seconds(-2), 0, 1e-12);
}

TEST(SimulatedLink, AStallHoldsWhatIsOnItsWay) {
    LinkParameters parameters;
    parameters.bits_per_second = 8e6;
    parameters.stalls = {{0.05, 2}};
    SimulatedLink link(parameters);
    EXPECT_NEAR(link.send(0, 100'000).departed, 2.1, 1e-12);
    EXPECT_NEAR(link.send(2.2, 100'000).departed, 2.3, 1e-12);
    parameters.bits_per_second = 0;
    SimulatedLink unlimited(parameters);
    EXPECT_NEAR(unlimited.send(0.5, 1).departed, 2.05, 1e-12);
}

TEST(SimulatedLink, ARateStepCountsFromItsMoment) {
    LinkParameters parameters;
    parameters.bits_per_second = 8e6;
    parameters.rate_steps = {{0.05, 0.8e6}, {10, 80e6}};
    SimulatedLink link(parameters);
    EXPECT_NEAR(link.send(0, 100'000).departed, 0.05 + 0.5, 1e-12);
    EXPECT_NEAR(link.send(10, 100'000).departed, 10.01, 1e-12);
}

TEST(SimulatedLink, JitterIsBoundedRepeatableAndKeepsOrder) {
    LinkParameters parameters;
    parameters.jitter_seconds = 0.02;
    SimulatedLink a(parameters), b(parameters);
    parameters.seed = 2;
    SimulatedLink other(parameters);
    double last = 0;
    double sum = 0;
    bool differs = false;
    for (int i = 0; i < 2000; ++i) {
        double const now = i * 0.03;
        double const arrived = a.send(now, 10).arrived;
        EXPECT_EQ(arrived, b.send(now, 10).arrived);
        differs = differs || arrived != other.send(now, 10).arrived;
        EXPECT_GE(arrived, last);
        EXPECT_GE(arrived - now, 0);
        EXPECT_LE(arrived - now, 0.02);
        sum += arrived - now;
        last = arrived;
    }
    EXPECT_TRUE(differs);
    EXPECT_NEAR(sum / 2000, 0.01, 0.001);
    for (int i = 0; i < 100; ++i) { // close together: they must not overtake
        double const arrived = a.send(100 + i * 0.001, 10).arrived;
        EXPECT_GE(arrived, last);
        last = arrived;
    }
}

} // namespace
} // namespace framelet::bench
