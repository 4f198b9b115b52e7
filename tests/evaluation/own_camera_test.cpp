// Tests a camera of the viewer's own in a scene that stands still. Nothing here is about speed.
#include "tests/evaluation/own_camera.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/evaluation/small_run.h"

namespace framelet::bench {
namespace {

TEST(OwnCamera, ARiseIsAboveTheLeastBefore) {
    EXPECT_TRUE(never_rises({}));
    EXPECT_TRUE(never_rises({3, 3, 2, 2.03, 1}));
    EXPECT_FALSE(never_rises({3, 2, 2.03, 2.05}));
}

TEST(OwnCamera, StandingIsBetterThanWalking) {
    OwnCameraOptions options;
    options.viewport = {96, 54};
    options.jumps = 2;
    options.costs = usual_costs();
    auto const figures =
        measure_own_camera(bundled("foliage"), source / "tests/evaluation/flights/foliage.json", options);
    EXPECT_EQ(figures["scene"], "foliage");
    EXPECT_GT(figures["standing_psnr"], figures["walking_psnr"]);
    EXPECT_GT(figures["walking_psnr"], 12);
    EXPECT_EQ(figures["jumps"], 2);
}

TEST(BenchScene, BakedClipsJumpWithinAFrame) {
    auto const stepped = load_bench_scene(bundled("flicker"));
    auto const baked = load_bench_scene(bundled("flicker"), Clips::baked);
    ASSERT_EQ(stepped->posed->switches().size(), 1u);
    ASSERT_EQ(baked->posed->switches().size(), 1u) << "the server finds them";
    auto const& jumps = stepped->posed->switches()[0].switches;
    auto const& found = baked->posed->switches()[0].switches;
    ASSERT_EQ(found.size(), jumps.size());
    for (std::size_t i = 0; i < jumps.size(); ++i) {
        if (jumps[i].time > 0) { // where the clip begins again nothing is baked
            EXPECT_NEAR(found[i].time, jumps[i].time - 0.5 / 30, 1e-6);
        }
    }
    for (auto const& [time, same] : {std::pair(0.71, true), {0.735, false}, {0.76, true}, {2.5, true}}) {
        pose_at(*stepped, time);
        pose_at(*baked, time);
        EXPECT_EQ(same_pose(stepped->pose, baked->pose), same) << time;
    }
}

TEST(OwnCamera, WithoutClipsNothingMoves) {
    auto const scene = load_bench_scene(bundled("stop"), Clips::none);
    pose_at(*scene, 0);
    ScenePose const first = scene->pose;
    pose_at(*scene, 1);
    EXPECT_TRUE(same_pose(first, scene->pose));
    EXPECT_EQ(scene->duration, 0);
}

} // namespace
} // namespace framelet::bench
