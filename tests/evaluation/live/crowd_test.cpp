// Tests some viewers of one server, once by themselves and once beside one that reads nothing: all of them are served
// and counted. How well they are served, `framelet-bench live --viewers` measures.
#include "tests/evaluation/live/crowd.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/error.h"

namespace framelet::bench {
namespace {

CrowdOptions crowd_of(int viewers) {
    CrowdOptions options;
    options.viewers = viewers;
    options.viewport = {128, 72};
    options.seconds = 3;
    return options;
}

TEST(Crowd, EveryViewerIsServedAndCountedBesideAStalledOneToo) {
    auto const scene = load_bench_scene(FRAMELET_SOURCE_DIR "/scenes/vehicle_chase.glb");
    CrowdOptions options = crowd_of(3);
    options.stalled = true;
    nlohmann::json const figures = measure_crowd(*scene, options);
    EXPECT_EQ(figures["scene"], "vehicle_chase");
    for (char const* const run : {"alone", "with_stalled"}) {
        nlohmann::json const& viewers = figures[run]["viewers"];
        ASSERT_EQ(viewers.size(), 3u) << run;
        double bytes = 0, least = 1e9;
        for (nlohmann::json const& viewer : viewers) {
            EXPECT_GT(viewer["pictures_per_second"], 0) << run;
            EXPECT_GT(viewer["kB_per_second"], 0) << run;
            bytes += viewer["kB_per_second"].get<double>();
            least = std::min(least, viewer["pictures_per_second"].get<double>());
        }
        EXPECT_NEAR(figures[run]["all"]["kB_per_second"], bytes, 1e-9 * bytes) << run;
        EXPECT_EQ(figures[run]["all"]["least_pictures_per_second"], least) << run;
        EXPECT_GT(figures[run]["all"]["server_busy"], 0) << run;
    }
}

TEST(Crowd, AViewerThatIsRefusedIsSaid) {
    auto const scene = load_bench_scene(FRAMELET_SOURCE_DIR "/scenes/vehicle_chase.glb");
    CrowdOptions options = crowd_of(1);
    options.viewport = {1, 1'000'000}; // too large for a picture
    EXPECT_THROW(measure_crowd(*scene, options), ConnectionError);
}

} // namespace
} // namespace framelet::bench
