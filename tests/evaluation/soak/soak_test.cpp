// Tests a short soak: a healthy server comes through, and everything is looked at.
#include "tests/evaluation/soak/soak.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace framelet::bench {
namespace {

TEST(Soak, AServerComesThroughABitOfIt) {
    auto const scene = load_bench_scene(FRAMELET_SOURCE_DIR "/scenes/vehicle_chase.glb");
    SoakOptions options;
    options.viewers = 3;
    options.seconds = 6;
    options.storm_seconds = 2;
    testing::internal::CaptureStdout();
    nlohmann::json const figures = run_soak(*scene, options);
    std::string const printed = testing::internal::GetCapturedStdout();
    EXPECT_TRUE(figures["failures"].empty()) << figures["failures"];
    ASSERT_FALSE(figures["rounds"].empty());
    EXPECT_NE(printed.find("the server's memory is NOT JUDGED"), std::string::npos) << printed;
    EXPECT_EQ(figures["memory"]["judged"], false);
    int events = 0;
    for (auto const& round : figures["rounds"]) {
        events += round["events"].get<int>();
        EXPECT_EQ(round["exact"], options.viewers);
        EXPECT_GT(round["resident_bytes"], 10e6);
        EXPECT_GT(round["descriptors"], options.viewers);
    }
    EXPECT_GT(events, 0);
}

TEST(Soak, ViewersThatOnlyFlyComeToRestWhereTheyPassed) {
    auto const scene = load_bench_scene(FRAMELET_SOURCE_DIR "/scenes/vehicle_chase.glb");
    SoakOptions options;
    options.viewers = 2;
    options.seconds = 3;
    options.storm_seconds = 1.5;
    options.events = 0;
    options.viewport = {120, 80};
    options.flight = parse_camera_path(R"({"keys": [{"time": 0, "position": [0, 2, 0], "target": [0, 1, -9]},
                                       {"time": 1, "position": [5, 3, 0], "target": [0, 1, -9]}]})",
                                       "flight");
    nlohmann::json const figures = run_soak(*scene, options);
    EXPECT_TRUE(figures["failures"].empty()) << figures["failures"];
    ASSERT_FALSE(figures["rounds"].empty());
    EXPECT_EQ(figures["rounds"][0]["events"], 0);
    EXPECT_EQ(figures["rounds"][0]["exact"], 2);
}

/// The server serves another scene than the one that the reference is rendered of.
TEST(Soak, SaysWhereAPictureIsNotWhatItShouldBe) {
    auto const scene = load_bench_scene(FRAMELET_SOURCE_DIR "/scenes/vehicle_chase.glb");
    scene->file = FRAMELET_SOURCE_DIR "/scenes/globe.glb";
    SoakOptions options;
    options.viewers = 1;
    options.seconds = 1;
    options.storm_seconds = 0.5;
    EXPECT_FALSE(run_soak(*scene, options)["failures"].empty());
}

} // namespace
} // namespace framelet::bench
