// Tests methods whose viewer moves what it holds: the camera's own motion, and whole frames with depth beside those
// without.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/evaluation/small_run.h"

namespace framelet::bench {
namespace {

using Warp = SmallRuns;

TEST(CameraTurn, GoesBackAndForthAtOneSpeed) {
    CameraTurn const turn{90, 30};
    EXPECT_EQ(turned_degrees(turn, -1), 0);
    EXPECT_EQ(turned_degrees(turn, 0), 0);
    EXPECT_NEAR(turned_degrees(turn, 0.1), 9, 1e-9);
    EXPECT_NEAR(turned_degrees(turn, 1 / 3.0), 30, 1e-9);
    EXPECT_NEAR(turned_degrees(turn, 2 / 3.0), 0, 1e-9);
    EXPECT_NEAR(turned_degrees(turn, 1), -30, 1e-9);
    EXPECT_NEAR(turned_degrees(turn, 4 / 3.0 + 0.1), 9, 1e-9);
    Camera const camera = look_at({1, 2, 3}, {5, 2, 3}, {0, 1, 0}, 1);
    Camera const after = turned(camera, turn, 1 / 3.0);
    EXPECT_NEAR(glm::dot(after.forward(), camera.forward()), std::cos(glm::radians(30.0f)), 1e-5f);
    EXPECT_NEAR(glm::dot(after.up(), camera.up()), 1, 1e-5f);
    EXPECT_LT(glm::dot(after.forward(), camera.right()), 0) << "to the left";
    EXPECT_EQ(turned(camera, {}, 1), camera);
}

TEST_F(Warp, FramesThatStandStillAreShownAsTheyCame) {
    auto const scene = load_bench_scene(bundled("teleport")); // nothing moves until the camera cuts
    auto const found = records(*scene, {"framed+h264", "framed+warp"}, small_run({96, 64}, 20));
    EXPECT_NEAR(found[1].measures[0].mse, found[0].measures[0].mse, 0.05 * found[0].measures[0].mse);
    EXPECT_LT(mean_squared_error(found[1].sample, found[0].sample), 1e-5);
}

TEST_F(Warp, FramesAreMovedToWhereTheCameraIs) {
    auto const scene = load_bench_scene(bundled("vehicle_chase"));
    RunParameters parameters = small_run({96, 64}, 20);
    parameters.link = {.bits_per_second = 20e6, .delay_seconds = 0.05};
    parameters.rivals = plain_rivals; // they leave all of the delay to the viewer
    auto const found = records(*scene, {"framed+h264", "framed+warp"}, parameters);
    EXPECT_LT(mean_mse(found[1]), 0.6 * mean_mse(found[0]));
    // More bytes are sent since shapes and tracks travel as well, within the same limit.
    EXPECT_GT(found[1].run.bytes, found[0].run.bytes);
}

/// Joints, morph targets, shadows of what turns: what `compare` shows of them in large, in small. The goals that are
/// met; in so small a picture the fan's share is 0.65 to 0.73, by how a processor rounds and which moments are met.
TEST_F(Warp, WhatBendsOrTurnsErrsLessThanUnmovedAndThanMovedFrames) {
    RunParameters parameters = small_run({240, 240}, 12);
    parameters.seconds = 1;
    parameters.frames_per_second = 2;
    struct Goal {
        char const* scene;
        double of_unmoved, of_moved_frames; ///< greatest share of their error
    };
    for (Goal const& goal : {Goal{"walker", 0.7, 0.9}, {"flag", 1, 0.9}, {"fan", 0.8, INFINITY}}) {
        auto const scene = load_bench_scene(bundled(goal.scene));
        auto const found = records(*scene, {"framelet", "framelet-unwarped", "framed+warp"}, parameters);
        EXPECT_LT(mean_mse(found[0]), goal.of_unmoved * mean_mse(found[1])) << goal.scene;
        EXPECT_LT(mean_mse(found[0]), goal.of_moved_frames * mean_mse(found[2])) << goal.scene;
    }
}

/// The link's delay is so long that no message of the run knows of the turn.
TEST_F(Warp, ATurnShowsBeforeAnyMessageKnowsOfIt) {
    auto const scene = load_bench_scene(bundled("teleport"));
    scene->turn = {.degrees_per_second = 30, .reach_degrees = 30};
    RunParameters parameters = small_run({96, 64}, 20);
    parameters.seconds = 0.3;
    parameters.link.delay_seconds = 0.3;
    parameters.rivals = plain_rivals;
    auto const found = records(*scene, {"framed+h264", "framed+warp", "framelet"}, parameters);
    for (std::size_t i = 2; i < found[0].measures.size(); ++i) {
        EXPECT_LT(found[1].measures[i].mse, 0.5 * found[0].measures[i].mse) << i;
        EXPECT_LT(found[2].measures[i].mse, 0.5 * found[0].measures[i].mse) << i;
    }
}

} // namespace
} // namespace framelet::bench
