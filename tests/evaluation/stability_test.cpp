// Tests properties of `stability`'s measures, and the whole verb at a tiny size. Nothing here is about speed.
#include "tests/evaluation/stability.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/error.h"
#include "tests/evaluation/cycle_log.h"
#include "tests/evaluation/scene_events.h"
#include "tests/evaluation/settling.h"
#include "tests/evaluation/small_run.h"

namespace framelet::bench {
namespace {

Settling settle(std::vector<double> const& errors) {
    std::vector<double> times;
    for (std::size_t i = 0; i < errors.size(); ++i) {
        times.push_back(5 + 0.1 * static_cast<double>(i));
    }
    return measure_settling(times, errors, 5, 2);
}

TEST(Settling, AnErrorThatFallsOnceHasSettledOnce) {
    Settling const result = settle({0.8, 0.4, 0.15, 0.1, 0.1, 0.1, 0.1, 0.1});
    EXPECT_DOUBLE_EQ(result.final_level, 0.1);
    EXPECT_DOUBLE_EQ(result.peak, 0.8);
    EXPECT_NEAR(result.first.value(), 0.2, 1e-9);
    EXPECT_NEAR(result.settled.value(), 0.2, 1e-9);
    EXPECT_NEAR(result.overshoot, 1.5, 1e-9);
}

TEST(Settling, OneThatRisesAgainSettlesLater) {
    Settling const result = settle({0.8, 0.1, 0.5, 0.1, 0.1, 0.1, 0.1, 0.1});
    EXPECT_NEAR(result.first.value(), 0.1, 1e-9);
    EXPECT_NEAR(result.settled.value(), 0.3, 1e-9);
    EXPECT_NEAR(result.overshoot, 5, 1e-9);
}

TEST(Settling, OneThatSwingsDoesNot) {
    EXPECT_FALSE(settle({0.8, 0.1, 0.5, 0.1, 0.1, 0.5, 0.1, 0.1, 0.5, 0.1, 0.5, 0.1}).settled);
}

TEST(Settling, NoErrorIsAsGoodAsHardlyAny) {
    Settling const result = settle({1e-5, 0, 1.5e-5, 0, 0, 0, 0, 0});
    EXPECT_DOUBLE_EQ(result.final_level, settled_floor);
    EXPECT_EQ(result.settled.value(), 0);
}

TEST(CycleLog, ConservationIsAMeanOverItsTime) {
    std::vector<CycleEntry> const entries{{0, 100, 90}, {1, 100, 150}, {2, 100, 100}, {3, 100, 80}};
    Conservation const conservation = measure_conservation(entries, 0, 4);
    EXPECT_DOUBLE_EQ(conservation.samples, 340) << "the last one has not ended";
    EXPECT_DOUBLE_EQ(conservation.budget, 300);
    EXPECT_DOUBLE_EQ(conservation.largest_share, 1.5);
    // Short cycles compensate each other within a tenth of a second.
    std::vector<CycleEntry> const hasty{{0, 1000, 30}, {0.04, 1000, 90}, {0.08, 1000, 10}, {0.2, 1000, 0}};
    EXPECT_DOUBLE_EQ(measure_conservation(hasty, 0, 1).largest_share, 130.0 / 200);
}

using Stability = SmallRuns;

TEST_F(Stability, EveryEventIsToldOfAndTheBudgetIsKept) {
    StudyOptions options = study(small_run({48, 32}, 20));
    options.samples_per_side = 2;
    options.scenes = {bundled("stop"), bundled("teleport")};
    auto const runs = measure_stability(options, {8, 128})["runs"];
    ASSERT_EQ(runs.size(), 4u);
    for (auto const& run : runs) {
        EXPECT_EQ(run["events"].size(), events_of(run["scene"].get<std::string>()).times.size());
        for (auto const& event : run["events"]) {
            EXPECT_GE(event["final_mse"], settled_floor);
            EXPECT_GE(event["peak_mse"].get<double>() + settled_floor, event["final_mse"].get<double>());
            EXPECT_GE(event["overshoot"], 1);
            if (event.contains("settled_seconds")) {
                EXPECT_GE(event["settled_seconds"], event["first_seconds"]);
            }
        }
        EXPECT_GT(run["conservation"]["samples"], 0);
        // The bound is on the sum of all samples; for a while after a cut they may be cheaper than those with which the
        // rate was measured.
        EXPECT_LE(run["conservation"]["share"], 1.05);
    }
    options.scenes = {"no such scene.glb"};
    EXPECT_THROW(measure_stability(options, {8}), InputError);
}

} // namespace
} // namespace framelet::bench
