#include "server/stream/moment_choice.h"

#include <cmath>
#include <optional>
#include <set>

#include <gtest/gtest.h>

namespace framelet {
namespace {

ViewState state_at(SceneTime time, float x = 0) {
    ViewState state;
    state.view.viewport = {64, 48};
    state.view.camera.position.x = x;
    state.scene_time = time;
    return state;
}

/// Chooses a moment of the present where one is to be begun; returns the moment that is held.
std::optional<HeldMoment> choose(MomentChoice& moments, ViewState const& present, double now, double seconds = 0.1) {
    if (moments.observe(present, now)) {
        moments.begin({present, now, seconds});
    }
    return moments.held();
}

TEST(MomentChoice, WhatMovesIsSeenAtAFewMomentsASecond) {
    for (double const seconds : {0.1, 0.2, 0.02}) {
        MomentChoice moments;
        std::set<SceneTime> seen;
        for (int i = 0; i < 1000; ++i) {
            double const now = 5.003 + 0.001 * i;
            auto const moment = choose(moments, state_at(now), now, seconds);
            ASSERT_TRUE(moment);
            EXPECT_LE(now - moment->begun, seconds + 1e-9);
            EXPECT_EQ(moment->state.scene_time, moment->begun);
            seen.insert(moment->begun);
        }
        EXPECT_EQ(seen.size(), static_cast<std::size_t>(std::lround(1 / seconds)) + 1);
    }
}

TEST(MomentChoice, TheMoreIsRenderedTheSoonerAMomentEnds) {
    EXPECT_DOUBLE_EQ(moment_seconds(1e-9), most_moment_seconds);
    EXPECT_DOUBLE_EQ(moment_seconds(2), 0.2);
    EXPECT_DOUBLE_EQ(moment_seconds(1e9), least_moment_seconds);
    for (double rate = 1e-3; rate < 1e3; rate *= 1.1) {
        EXPECT_GE(moment_seconds(rate), moment_seconds(1.1 * rate)) << rate;
    }
}

TEST(MomentChoice, WhatTakesLongToBeginLastsLonger) {
    EXPECT_EQ(worth_posing(0.1, 0), 0.1);
    EXPECT_EQ(worth_posing(0.1, 0.02), 0.1) << "a fifth of it";
    EXPECT_EQ(worth_posing(0.1, 0.03), 0.2);
    EXPECT_EQ(worth_posing(0.05, 0.15), 0.8);
    EXPECT_LE(worth_posing(0.4, 1e9), 4) << "something is to be seen at last";
}

TEST(MomentChoice, WhereAMomentIsSoonCompleteTheNextAreShorter) {
    MomentChoice moments;
    EXPECT_EQ(moments.standing_seconds(), least_moment_seconds);
    auto const begin = [&](double now, std::optional<double> completed) {
        moments.begin({state_at(now), now, moments.standing_seconds()});
        if (completed) {
            moments.note_complete(now + *completed);
        }
    };
    begin(1, 0.3 * least_moment_seconds);
    begin(2, 0.7 * least_standing_seconds);
    EXPECT_EQ(moments.standing_seconds(), least_standing_seconds);
    begin(3, 0.1 * least_standing_seconds); // that took more than half of its time: as long as it was
    EXPECT_EQ(moments.standing_seconds(), least_standing_seconds);
    begin(4, {}); // there are no shorter ones
    EXPECT_EQ(moments.standing_seconds(), least_standing_seconds);
    begin(5, {}); // that was never complete
    EXPECT_EQ(moments.standing_seconds(), least_moment_seconds);
}

TEST(MomentChoice, ViewersOfOneSceneChangeTogether) {
    MomentChoice one, other;
    double const late = 7.04;
    for (double now = 7.01; now < 8; now += 0.002) {
        auto const moment = choose(one, state_at(now), now);
        if (now > late) {
            auto const same = choose(other, state_at(now), now);
            if (now > 7.1) {
                EXPECT_EQ(moment->state.scene_time, same->state.scene_time);
            }
        }
    }
}

TEST(MomentChoice, AtRestThePresentIsRendered) {
    MomentChoice moments;
    ASSERT_TRUE(choose(moments, state_at(1, 2), 10));
    EXPECT_TRUE(choose(moments, state_at(1, 2), 10 + 0.9 * rest_seconds));
    EXPECT_FALSE(choose(moments, state_at(1, 2), 10 + 1.1 * rest_seconds));
    // A camera that begins to move is seen at once.
    auto const moment = choose(moments, state_at(1, 3), 12.01);
    ASSERT_TRUE(moment);
    EXPECT_EQ(moment->state.view.camera.position.x, 3);
}

TEST(MomentChoice, AfterTheClockWasSetTheMomentIsCompletedFirst) {
    double const later = 10 + 0.9 * stop_seconds;
    for (bool const completes : {false, true}) {
        MomentChoice moments;
        choose(moments, state_at(1), 9.99);
        moments.note_clock_set();
        ASSERT_TRUE(choose(moments, state_at(1.1), 10, 1));
        if (completes) {
            moments.note_complete(10.01);
        }
        EXPECT_TRUE(choose(moments, state_at(1.1), 10 + 0.9 * rest_seconds, 1));
        EXPECT_EQ(choose(moments, state_at(1.1), later, 1).has_value(), !completes);
        EXPECT_FALSE(choose(moments, state_at(1.1), 10 + 1.1 * stop_seconds, 1));
        ASSERT_TRUE(choose(moments, state_at(3), 12, 1)); // the clock goes on
        EXPECT_FALSE(choose(moments, state_at(3), 12 + 1.1 * rest_seconds, 1)) << "nobody set it this time";
        moments.note_clock_set();
        ASSERT_TRUE(choose(moments, state_at(9), 14, 1));
        EXPECT_FALSE(choose(moments, state_at(9), 14 + 1.1 * rest_seconds, 1)) << "nothing of that time is held";
    }
}

TEST(MomentChoice, WhatHasNotBeenLookedAtForAWhileHasNotRested) {
    MomentChoice moments;
    double const begun = choose(moments, state_at(1), 5.21, 0.4)->begun;
    EXPECT_EQ(choose(moments, state_at(1.2), 5.4, 0.4)->begun, begun);
    EXPECT_EQ(choose(moments, state_at(1.3), 5.5, 0.4)->begun, begun);
}

TEST(MomentChoice, AnotherSizeOrExposureBeginsAnew) {
    MomentChoice moments;
    double now = 3.001;
    choose(moments, state_at(1), now);
    ViewState other = state_at(1.001);
    other.transform.exposure = 2;
    EXPECT_EQ(choose(moments, other, now += 0.001)->state.transform.exposure, 2);
    other.view.viewport = {32, 32};
    EXPECT_EQ(choose(moments, other, now += 0.001)->state.view.viewport, other.view.viewport);
    moments.forget();
    other.scene_time = 9;
    EXPECT_EQ(choose(moments, other, now += 0.001)->state.scene_time, 9);
}

} // namespace
} // namespace framelet
