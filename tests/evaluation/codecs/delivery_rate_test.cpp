#include "tests/evaluation/codecs/delivery_rate.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/evaluation/codecs/simulated_link.h"

namespace framelet::bench {
namespace {

TEST(DeliveryRate, FallsAtOnceAndRisesByHalf) {
    DeliveryRate rate{1000};
    rate = update_delivery_rate(rate, 100, 1);
    EXPECT_EQ(rate.bytes_per_second, 100);
    rate = update_delivery_rate(rate, 500, 1);
    EXPECT_EQ(rate.bytes_per_second, 300);
    rate = update_delivery_rate(rate, 500, 0);
    EXPECT_TRUE(std::isinf(rate.bytes_per_second)) << "no limit was felt";
    rate = update_delivery_rate(rate, 500, 2);
    EXPECT_EQ(rate.bytes_per_second, 250);
}

TEST(DeliveryRate, WhatWaitsIsTakenOffTheNextFrame) {
    DeliveryRate const rate{1000};
    EXPECT_NEAR(frame_budget(rate, 0.1, 0), 95, 1e-9);
    EXPECT_NEAR(frame_budget(rate, 0.1, 100), 95, 1e-9) << "the last frame passes while this one is made";
    EXPECT_NEAR(frame_budget(rate, 0.1, 140), 55, 1e-9);
    EXPECT_NEAR(frame_budget(rate, 0.1, 5000), 10, 1e-9) << "never nothing";
    EXPECT_TRUE(std::isinf(frame_budget({INFINITY}, 0.1, 5000)));
}

/// Simulates a sender of frames that are as large as they may be, over a link whose rate falls to a fifth and comes
/// back.
TEST(DeliveryRate, FramesFollowALinkWhoseRateChanges) {
    constexpr double period = 0.1;
    constexpr double delay = 0.03;
    LinkParameters parameters;
    parameters.bits_per_second = 8e6;
    parameters.delay_seconds = delay;
    parameters.jitter_seconds = 0.02;
    parameters.rate_steps = {{3, 1.6e6}, {6, 8e6}};
    SimulatedLink link(parameters);
    DeliveryRate rate{1e6};
    struct Answer {
        double when, bytes, seconds;
    };
    std::vector<Answer> answers;
    for (int frame = 0; frame < 90; ++frame) {
        double const begin = frame * period;
        std::erase_if(answers, [&](Answer const& answer) {
            if (answer.when <= begin) {
                rate = update_delivery_rate(rate, answer.bytes, answer.seconds);
            }
            return answer.when <= begin;
        });
        double const bytes = frame_budget(rate, period, link.backlog_bytes(begin));
        double const sent = begin + period;
        auto const delivery = link.send(sent, static_cast<std::size_t>(bytes));
        answers.push_back({delivery.arrived + delay, bytes, delivery.departed - delivery.begun});
        double const late = delivery.arrived - sent - delay;
        bool const changing = (sent > 2.95 && sent < 4.75) || (sent > 5.95 && sent < 7.2);
        if (!changing) {
            EXPECT_LT(late, period + parameters.jitter_seconds) << "no queue builds up, frame " << frame;
            EXPECT_GT(bytes, 0.8 * period * link.rate_at(sent) / 8) << "nor is the link left idle, frame " << frame;
        }
    }
}

} // namespace
} // namespace framelet::bench
