#include "tests/evaluation/scene_events.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "scenes/failure_scenes.h"

namespace framelet::bench {
namespace {

TEST(SceneEvents, AreThoseOfTheGenerator) {
    SceneEvents const stop = events_of(make_stop_scene({.duration = 6, .moving = 3}), 6);
    EXPECT_EQ(stop.times, std::vector<double>{3});
    SceneEvents const flicker = events_of(make_flicker_scene({.duration = 4, .lit = {true, true, false, false}}), 4);
    EXPECT_EQ(flicker.times, std::vector<double>{2});
    EXPECT_EQ(events_of("teleport").times, (std::vector<double>{1, 2, 3, 4, 5}));
}

TEST(SceneEvents, AShortRunSeesOne) {
    EXPECT_EQ(window_start("stop", 2), 2) << "half of it before the stop";
    EXPECT_EQ(window_start("teleport", 2), 0);
    EXPECT_EQ(window_start("globe", 2), 2) << "no event: the middle";
    EXPECT_EQ(window_start("vehicle_approach", 4), 1) << "no later than the scene has so many seconds left";
    EXPECT_EQ(window_start("a scene of somebody's", 2), 0);
}

TEST(SceneEvents, AClockIsSetToWhereNothingIsAnnounced) {
    for (std::string const name : {"flicker", "teleport"}) {
        std::vector<double> const events = events_of(name).times;
        for (ClockSetting const& setting : unannounced_settings(name, 6, 4)) {
            EXPECT_FALSE(std::ranges::any_of(
                events, [&](double event) { return event > setting.time && event < setting.time + 0.75; }))
                << name << " at " << setting.time;
        }
    }
    std::vector<ClockSetting> const settings{{0.25, 4}, {0.75, 1}};
    EXPECT_DOUBLE_EQ(clock_at(settings, 2, 0.2), 2.2);
    EXPECT_DOUBLE_EQ(clock_at(settings, 2, 0.35), 4.1);
    EXPECT_DOUBLE_EQ(clock_at(settings, 2, 0.35, 0.2), 2.35) << "who hears of it late goes on as before";
    EXPECT_DOUBLE_EQ(clock_at(settings, 2, 1, 0.2), 1.25);
    EXPECT_EQ(unannounced_settings("walker", 4, 2).size(), 4u);
}

} // namespace
} // namespace framelet::bench
