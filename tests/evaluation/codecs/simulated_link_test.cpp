#include "tests/evaluation/codecs/simulated_link.h"

#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "common/error.h"

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
    EXPECT_NEAR(link.backlog_bytes(1.04), 60'000, 1e-6);
    auto const second = link.send(1.05, 100'000);
    EXPECT_NEAR(second.departed, 1.2, 1e-12) << "waits for the first";
    EXPECT_NEAR(second.begun, 1.1, 1e-12);
    EXPECT_EQ(link.backlog_bytes(2), 0);
    EXPECT_NEAR(link.send(3, 0).arrived, 3.05, 1e-12);
}

TEST(SimulatedLink, UnlimitedTakesOnlyItsDelay) {
    LinkParameters parameters;
    parameters.delay_seconds = 0.01;
    SimulatedLink link(parameters);
    EXPECT_NEAR(link.send(-2, 1'000'000'000).arrived, -1.99, 1e-12);
    EXPECT_EQ(link.backlog_bytes(-2), 0);
}

TEST(SimulatedLink, WhatIsLostComesARoundTripLater) {
    LinkParameters const parameters{.delay_seconds = 0.05, .loss = 0.2};
    SimulatedLink link(parameters);
    int lost = 0;
    for (int i = 0; i < 1000; ++i) {
        double const seconds = link.send(i, 1500).arrived - i;
        lost += seconds > 0.1 ? 1 : 0;
        EXPECT_NEAR(seconds, seconds > 0.1 ? 0.15 : 0.05, 1e-9);
    }
    EXPECT_NEAR(lost, 200, 40);
    EXPECT_NEAR(link.send(1000, 150'000).arrived, 1000.15, 1e-9) << "one of a hundred packets is";
    EXPECT_NEAR(link.send(1000, 1).arrived, 1000.15, 1e-9) << "waits for it";
}

TEST(SimulatedLink, IsReadFromAFile) {
    auto const file = std::filesystem::temp_directory_path() / "framelet-link-test.json";
    std::ofstream(file) << R"({"megabits": 8, "delay_ms": 50, "steps": [[1, 4]], "stalls": [[0.5, 0.25]]})";
    SimulatedLink link(read_link(file));
    EXPECT_NEAR(link.send(0.4, 200'000).arrived, 0.9, 1e-9);
    EXPECT_EQ(link.rate_at(1.5), 4e6);
    for (char const* const text : {"", "[1]", R"({"loss": 1})", R"({"steps": [[1]]})", R"({"delay_ms": -1})"}) {
        std::ofstream(file) << text;
        EXPECT_THROW(read_link(file), InputError) << text;
    }
    std::filesystem::remove(file);
    EXPECT_THROW(read_link(file), InputError);
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

TEST(SimulatedLink, AMessageLastsOverStallsAndSteps) {
    LinkParameters parameters;
    parameters.bits_per_second = 8e6; // one byte a microsecond
    parameters.stalls = {{0.02, 0.1}, {0.15, 0.05}};
    parameters.rate_steps = {{0.14, 4e6}};
    SimulatedLink link(parameters);
    // The link carries 20 kB before the first stall, 20 kB up to the step, 5 kB up to the second stall, 10 kB after it.
    EXPECT_NEAR(link.send(0, 55'000).departed, 0.22, 1e-12);
    EXPECT_NEAR(link.backlog_bytes(0), 55'000, 1e-6);
    EXPECT_NEAR(link.backlog_bytes(0.01), 45'000, 1e-6);
    EXPECT_NEAR(link.backlog_bytes(0.07), 35'000, 1e-6) << "stalled";
    EXPECT_NEAR(link.backlog_bytes(0.145), 12'500, 1e-6);
    EXPECT_NEAR(link.backlog_bytes(0.21), 5'000, 1e-6);
    EXPECT_EQ(link.backlog_bytes(0.23), 0);
}

TEST(SimulatedLink, WhatWaitsIsCountedMessageByMessage) {
    LinkParameters parameters;
    parameters.bits_per_second = 8e6;
    SimulatedLink link(parameters);
    link.send(0, 10'000);
    link.send(0.002, 20'000);
    EXPECT_NEAR(link.backlog_bytes(0.002), 28'000, 1e-6);
    link.send(0.015, 5'000);
    EXPECT_NEAR(link.backlog_bytes(0.02), 15'000, 1e-6);
    EXPECT_NEAR(link.backlog_bytes(0.032), 3'000, 1e-6);

    parameters.bits_per_second = 0;
    parameters.stalls = {{1, 1}};
    SimulatedLink unlimited(parameters);
    unlimited.send(1.5, 1000);
    EXPECT_EQ(unlimited.backlog_bytes(1.9), 1000)
        << "a stall holds back what an unlimited link would have sent at once";
    EXPECT_EQ(unlimited.backlog_bytes(2), 0);
}

TEST(SimulatedLink, RefusesWhatNoLinkIs) {
    auto const with = [](auto change) {
        LinkParameters parameters;
        change(parameters);
        return parameters;
    };
    EXPECT_THROW(SimulatedLink(with([](auto& p) { p.bits_per_second = -1; })), InputError);
    EXPECT_THROW(SimulatedLink(with([](auto& p) { p.delay_seconds = NAN; })), InputError);
    EXPECT_THROW(SimulatedLink(with([](auto& p) { p.jitter_seconds = INFINITY; })), InputError);
    EXPECT_THROW(SimulatedLink(with([](auto& p) { p.stalls = {{1, 2}, {2, 1}}; })), InputError);
    EXPECT_THROW(SimulatedLink(with([](auto& p) { p.stalls = {{1, -2}}; })), InputError);
    EXPECT_THROW(SimulatedLink(with([](auto& p) { p.rate_steps = {{2, 1e6}, {1, 1e6}}; })), InputError);
    EXPECT_NO_THROW(SimulatedLink(with([](auto& p) { p.stalls = {{1, 2}, {3, 1}}; })));
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
    for (int i = 0; i < 100; ++i) { // sent close together: they must not overtake each other
        double const arrived = a.send(100 + i * 0.001, 10).arrived;
        EXPECT_GE(arrived, last);
        last = arrived;
    }
}

} // namespace
} // namespace framelet::bench
