// The whole wall-clock measurement with the real programs; nothing here depends on how fast they are.
#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "tests/evaluation/measures/measures.h"
#include "tests/evaluation/wall.h"

namespace framelet::bench {
namespace {

std::filesystem::path const source = FRAMELET_SOURCE_DIR;

TEST(Wall, TheClientsPicturesAreMeasuredAgainstTheReference) {
    auto const scene = load_bench_scene(source / "scenes/dim.glb");
    StudyOptions study;
    study.run.viewport = {96, 64};
    study.run.seconds = 1;
    study.run.reference_rate = 10;
    study.run.link.bits_per_second = 20e6;
    study.run.link.delay_seconds = 0.01;
    study.reference_cache = std::filesystem::temp_directory_path() / ("framelet-wall-" + std::to_string(getpid()));
    study.costs = read_cost_table(source / "tests/evaluation/costs.json");
    auto const figures =
        measure_wall(*scene, study, {.server_threads = 1, .display_rate = 30, .most_lead_seconds = 120});
    std::filesystem::remove_all(study.reference_cache);
    for (char const* const clock : {"wall", "virtual"}) {
        auto const& of_clock = figures[clock];
        ASSERT_EQ(of_clock["mse"].size(), 10u);
        EXPECT_GT(psnr_from_mse(of_clock["mse"][0].get<double>()), 30) << clock << ": the still picture was complete";
        EXPECT_LT(of_clock["mean"]["mse"].get<double>(), 0.05) << clock << ": the same scene through the same camera";
        EXPECT_GT(of_clock["cpu_seconds"]["server"].get<double>(), 0) << clock;
        EXPECT_GT(of_clock["cpu_seconds"]["viewer"].get<double>(), 0) << clock;
        EXPECT_GT(of_clock["bytes"].get<double>(), 1000) << clock << ": it moves";
        EXPECT_FALSE(of_clock["displayed"].empty()) << clock;
    }
}

} // namespace
} // namespace framelet::bench
