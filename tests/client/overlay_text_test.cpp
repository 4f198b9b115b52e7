#include "client/window/overlay/overlay_text.h"

#include <algorithm>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "client/viewer/commands.h"
#include "client/viewer/lacks.h"

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

TEST(RateMeter, MotionToPhotonIsTheMedianOfWhatWasMeasured) {
    RateMeter meter;
    for (double const seconds : {0.02, -1.0, 0.9, 0.03}) {
        meter.picture(seconds);
    }
    ASSERT_TRUE(meter.update(1, 0));
    EXPECT_DOUBLE_EQ(meter.pictures_per_second(), 4);
    EXPECT_DOUBLE_EQ(meter.photon_seconds(), 0.03);
    ASSERT_TRUE(meter.update(2, 0));
    EXPECT_DOUBLE_EQ(meter.photon_seconds(), -1);
}

std::string value_of(TextRows const& rows, std::string const& name) {
    for (auto const& [left, right] : rows) {
        if (left == name) {
            return right;
        }
    }
    return "no such row";
}

TEST(OverlayText, TheSignSaysThatAConnectionIsTriedForAgain) {
    EXPECT_EQ(sign_text({}), "");
    EXPECT_EQ(sign_text({.is_interrupted = true}), "no connection: trying again");
    EXPECT_EQ(sign_text({"opening a.glb", true, false, "0:03"}), "opening a.glb\nno connection: trying again\n0:03");
    std::string const both = sign_text({.is_interrupted = true, .has_mouse_look = true});
    EXPECT_EQ(both, std::string("no connection: trying again\n") + mouse_look_text);
}

TEST(OverlayText, ClockAndStatisticsReadWell) {
    EXPECT_EQ(clock_text({{12.346, true, 2}, 5}), "12.35 s (every 5.00 s), playing at 2x") << "as the bar has it";
    EXPECT_EQ(clock_text({{0, false, 0.5f}, 5}), "0.00 s (every 5.00 s), paused at 0.5x");
    EXPECT_EQ(clock_text({{3, true, 1}, 5}), "3.00 s (every 5.00 s), playing");
    EXPECT_EQ(clock_text({{3, true, 1}, 0}), "nothing moves in this scene");
    ClientStatistics statistics;
    statistics.samples = 1000;
    statistics.bytes = 250;
    statistics.batches = 1;
    TimeLine const time{{}, 4};
    TextRows const rows = figure_rows(statistics, time, true);
    EXPECT_EQ(value_of(rows, "done"), "coarse, 0% known");
    EXPECT_EQ(value_of(rows, "clock"), "0.00 s (every 4.00 s), paused");
    TextRows const details = detail_rows(statistics, RateMeter(), {640, 360}, "processor");
    EXPECT_EQ(value_of(details, "picture"), "640x360");
    EXPECT_EQ(value_of(details, "received"), "1 batch, 0 framelets, 0.25 B/sample");
    EXPECT_EQ(value_of(details, "round trip"), "not measured");
    statistics.lag_seconds = 0.1;
    statistics.coverage = 1;
    statistics.is_fine = true;
    EXPECT_EQ(value_of(figure_rows(statistics, time, true), "done"), "refining, 100% known");
    statistics.converged = true;
    TextRows const late = figure_rows(statistics, time, true);
    EXPECT_EQ(value_of(late, "clock"), "0.00 s (every 4.00 s), paused; the scene 100 ms late");
    EXPECT_EQ(value_of(late, "done"), "finished");
}

TEST(OverlayText, SaysThatASavedPictureWasNotFinished) {
    EXPECT_EQ(saved_text("a.png", "", PictureState::finished), "saved a.png");
    EXPECT_EQ(saved_text("a.png", "", PictureState::coarse), "saved a.png; it was not finished: still coarse");
    EXPECT_EQ(saved_text("a.exr", ", without depth", PictureState::refining),
              "saved a.exr, without depth; it was not finished: still refining");
}

TEST(StatisticsHistory, HasTheNewestFigureAndAMinuteOfOlderOnes) {
    StatisticsHistory history;
    EXPECT_EQ(history.plots().front().value, "0 a second");
    RateMeter meter;
    ClientStatistics statistics;
    statistics.server_samples_per_second = 2.5e6;
    for (int i = 1; i <= 200; ++i) {
        for (int picture = 0; picture < i; ++picture) {
            meter.picture(0.016);
        }
        ASSERT_TRUE(meter.update(i, 125000 * static_cast<std::uint64_t>(i)));
        statistics.server_busy = i / 400.0;
        history.add(meter, statistics);
    }
    std::vector<Plot> const plots = history.plots();
    ASSERT_EQ(plots.size(), 5u);
    EXPECT_EQ(plots[0].value, "200 a second");
    EXPECT_EQ(plots[1].value, "16 ms");
    EXPECT_EQ(plots[2].value, "1.0 Mbit/s");
    EXPECT_EQ(plots[3].value, "2.50 million samples/s");
    EXPECT_EQ(plots[4].value, "50% of the time");
    for (Plot const& plot : plots) {
        EXPECT_EQ(plot.values.size(), 120u);
    }
    EXPECT_EQ(plots[0].values.front(), 81);
    EXPECT_EQ(plots[0].values.back(), 200);
}

/// Every figure of the window is explained where one points at it, and in a table of the guide.
TEST(OverlayText, EachFigureIsExplained) {
    std::ifstream file(FRAMELET_SOURCE_DIR "/docs/GUIDE.md");
    std::string const guide{std::istreambuf_iterator<char>(file), {}};
    std::vector<std::string> names;
    for (Plot const& plot : StatisticsHistory().plots()) {
        names.push_back(plot.name);
    }
    for (TextRows const& rows : {figure_rows({}, {}, true), detail_rows({}, RateMeter(), {}, "")}) {
        for (auto const& [name, value] : rows) {
            names.push_back(name);
        }
    }
    for (std::string const& name : names) {
        EXPECT_NE(figure_tip(name), "") << name;
        EXPECT_NE(guide.find("\n| " + name + " |"), std::string::npos) << name;
    }
    EXPECT_EQ(figure_tip("no such figure"), "");
}

TEST(OverlayText, SaysThatAnotherControlsTheClock) {
    auto const says_so = [](TextRows const& rows) {
        return std::any_of(rows.begin(), rows.end(),
                           [](auto const& row) { return row.second.find(watching_text) != std::string::npos; });
    };
    EXPECT_FALSE(says_so(figure_rows({}, {}, true)));
    EXPECT_TRUE(says_so(figure_rows({}, {}, false)));
}

} // namespace
} // namespace framelet
