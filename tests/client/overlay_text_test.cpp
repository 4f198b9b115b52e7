#include "client/window/overlay_text.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(RateMeter, CountsWhatHappenedInItsInterval) {
    RateMeter meter;
    EXPECT_FALSE(meter.update(0.4, 1000));
    for (int i = 0; i < 30; ++i) {
        meter.frame(0.004);
    }
    ASSERT_TRUE(meter.update(0.5, 1000));
    EXPECT_DOUBLE_EQ(meter.frames_per_second(), 60);
    EXPECT_DOUBLE_EQ(meter.frame_seconds(), 0.004);
    EXPECT_DOUBLE_EQ(meter.bytes_per_second(), 2000);
    EXPECT_FALSE(meter.update(0.9, 5000));
    ASSERT_TRUE(meter.update(2.5, 5000));
    EXPECT_DOUBLE_EQ(meter.frames_per_second(), 0);
    EXPECT_DOUBLE_EQ(meter.bytes_per_second(), 2000);
}

TEST(RateMeter, ANewConnectionCountsFromZeroAgain) {
    RateMeter meter;
    meter.update(1, 5000);
    ASSERT_TRUE(meter.update(2, 10));
    EXPECT_EQ(meter.bytes_per_second(), 0);
}

TEST(OverlayText, ClockAndStatisticsReadWell) {
    EXPECT_EQ(clock_text({12.345, true, 2}), "12.35 s, playing at 2x");
    EXPECT_EQ(clock_text({0, false, 0.5f}), "0.00 s, paused at 0.5x");
    ClientStatistics statistics;
    statistics.samples = 1000;
    statistics.bytes = 250;
    TextRows const rows = statistics_rows(statistics, RateMeter(), {}, true, {640, 360});
    auto const value = [&](std::string const& name) {
        for (auto const& [left, right] : rows) {
            if (left == name) {
                return right;
            }
        }
        return std::string("no such row");
    };
    EXPECT_EQ(value("picture"), "640x360, covered 0%");
    EXPECT_EQ(value("network"), "0.00 Mbit/s, 0.25 B/sample");
    EXPECT_EQ(value("round trip"), "not measured");
    EXPECT_EQ(value("clock"), "0.00 s, paused at 1x");
    statistics.lag_seconds = 0.1;
    TextRows const late = statistics_rows(statistics, RateMeter(), {}, true, {640, 360});
    EXPECT_EQ(late.back().second, "0.00 s, paused at 1x; the scene 100 ms late");
}

TEST(OverlayText, SaysThatAnotherControlsTheClock) {
    auto const says_so = [](TextRows const& rows) {
        return std::any_of(rows.begin(), rows.end(),
                           [](auto const& row) { return row.second.find(watching_text) != std::string::npos; });
    };
    EXPECT_FALSE(says_so(help_rows(true)));
    EXPECT_TRUE(says_so(help_rows(false)));
    EXPECT_LT(help_rows(false).size(), help_rows(true).size());
    EXPECT_FALSE(says_so(statistics_rows({}, RateMeter(), {}, true, {640, 360})));
    EXPECT_TRUE(says_so(statistics_rows({}, RateMeter(), {}, false, {640, 360})));
}

} // namespace
} // namespace framelet
