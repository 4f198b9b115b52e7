// Tests the estimate beside simulated links, on the virtual clock.
#include "server/stream/flow/link_estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/evaluation/codecs/simulated_link.h"

namespace framelet {
namespace {

using bench::LinkParameters;
using bench::SimulatedLink;

/// A batch that was sent: when, how large, and what became of it; seconds, bytes.
struct Delivered {
    double sent = 0, bytes = 0;
    double departed = 0, arrived = 0;
    double queueing = 0; ///< from sending until the first byte leaves
};

/// A server that has always something to send: batches of what the renderer makes in a hundredth of a second, or
/// of what the link takes.
struct Sender {
    LinkEstimate estimate;
    double produced = 20e6; ///< bytes a second
    double burst = 1; ///< factor of `produced` for 20 of 60 ms, and for the last fifth of every second
    double bytes_per_sample = 0.5;
    double viewer_clock = -1000; ///< the viewer's clock when ours is at 0, seconds
    double jump = 0; ///< by which the viewer's clock is set after 4 seconds, seconds
    bool tells_time = true;
    std::vector<Delivered> log;

    void run(LinkParameters const& parameters, double seconds) {
        SimulatedLink link(parameters);
        double now = 0;
        std::uint64_t batch = 0, answered = 0;
        while (now < seconds) {
            double const back = parameters.delay_seconds;
            if (!estimate.has_room(now) || batch - answered >= 12) {
                double const answer = answered < batch ? log[answered].arrived + back : now;
                now = answer > now ? std::min(answer, now + 0.002) : now + 0.002;
            }
            while (answered < batch && log[answered].arrived + back <= now) {
                double const when = log[answered].arrived + back;
                ++answered;
                double const arrived = log[answered - 1].arrived;
                double const told = arrived + viewer_clock + (arrived > 4 ? jump : 0);
                estimate.acknowledged(answered, when, tells_time ? std::optional(told) : std::nullopt);
            }
            if (!estimate.has_room(now) || batch - answered >= 12) {
                continue;
            }
            bool const bursts = now - std::floor(now) > 0.8 || std::fmod(now, 0.06) < 0.02;
            double const now_produced = bursts ? burst * produced : produced;
            double const bytes = std::min(0.01 * now_produced, estimate.state().batch_bytes);
            estimate.begin(bytes / bytes_per_sample);
            now += bytes / now_produced;
            ++batch;
            SimulatedLink::Delivery const d = link.send(now, static_cast<std::size_t>(bytes));
            estimate.sent(batch, now, bytes);
            log.push_back({now, bytes, d.departed, d.arrived, d.begun - now});
        }
    }

    double most_queueing(double from, double to) const {
        double most = 0;
        for (Delivered const& d : log) {
            most = d.sent >= from && d.sent < to ? std::max(most, d.queueing) : most;
        }
        return most;
    }
    /// Share of what the link could carry that was sent in a span of time.
    double used(double from, double to, double bytes_per_second) const {
        double sum = 0;
        for (Delivered const& d : log) {
            sum += d.departed >= from && d.departed < to ? d.bytes : 0;
        }
        return sum / (bytes_per_second * (to - from));
    }
};

TEST(LinkEstimate, SteadySlowLinkIsFilledWithoutAQueue) {
    for (double const delay : {0.0, 0.015, 0.1}) {
        Sender sender;
        sender.run({.bits_per_second = 2.4e6, .delay_seconds = delay}, 8);
        // A rate that is tried shows its queue only a round trip later.
        EXPECT_LT(sender.most_queueing(2, 8), 0.05 + 0.5 * delay) << delay;
        EXPECT_GT(sender.used(2, 8, 300e3), 0.85) << delay;
        EXPECT_NEAR(sender.estimate.state().bytes_per_second, 300e3, 60e3) << delay;
        EXPECT_NEAR(sender.estimate.state().base_seconds, 2 * delay, 0.03) << delay;
        EXPECT_NEAR(sender.estimate.state().bytes_per_sample, 0.5, 1e-9);
    }
}

/// A rate that nothing was sent at is not known to be carried.
TEST(LinkEstimate, BurstsOfWhatHardlyFillsTheLinkMakeNoQueue) {
    for (double const produced : {30e3, 60e3, 120e3, 180e3, 240e3}) {
        for (double const delay : {0.0, 0.015}) {
            Sender sender;
            sender.produced = produced;
            sender.burst = 10;
            sender.run({.bits_per_second = 2.4e6, .delay_seconds = delay}, 12);
            EXPECT_LT(sender.most_queueing(3, 12), 0.05) << produced << " " << delay;
            double const offered =
                produced / 300e3 * (1 + 9 * (0.2 + 0.8 / 3)); // load of the link; bursts are longer than queues
            EXPECT_GT(sender.used(3, 12, 300e3), 0.65 * std::min(1.0, offered)) << produced << " " << delay;
        }
    }
}

TEST(LinkEstimate, FollowsStepsOfTheRate) {
    for (double const delay : {0.0, 0.03}) {
        Sender sender;
        // The server produces less where there is a delay: with more in flight than the slow link takes in a second
        // nobody could do it.
        sender.produced = delay > 0 ? 2.5e6 : 20e6;
        sender.run({.bits_per_second = 100e6,
                    .delay_seconds = delay,
                    .rate_steps = {{.begin = 4, .bits_per_second = 1e6}, {.begin = 8, .bits_per_second = 20e6}}},
                   12);
        EXPECT_GT(sender.used(2, 4, std::min(sender.produced, 12.5e6)), 0.6) << delay;
        EXPECT_LT(sender.most_queueing(5, 8), 0.05) << delay;
        EXPECT_GT(sender.used(5.5, 8, 125e3), 0.8) << delay;
        EXPECT_GT(sender.used(10, 12, 2.5e6), 0.7) << delay;
        EXPECT_LT(sender.most_queueing(9, 12), 0.05) << delay;
    }
}

TEST(LinkEstimate, GoesOnAfterAStall) {
    Sender sender;
    sender.run({.bits_per_second = 20e6, .delay_seconds = 0.02, .stalls = {{.begin = 3, .seconds = 2}}}, 9);
    EXPECT_GT(sender.used(6, 9, 2.5e6), 0.8);
    EXPECT_LT(sender.most_queueing(6, 9), 0.05);
}

/// One batch is in flight when a stall begins that is the first queue met: its answer looks like a link that hardly
/// carries anything, and nothing else is there to say otherwise.
TEST(LinkEstimate, NothingInFlightIsRoomSoonWhateverTheRate) {
    LinkEstimate estimate;
    double now = 0;
    std::uint64_t batch = 0;
    auto const deliver = [&](double bytes, double seconds) {
        estimate.begin(bytes);
        estimate.sent(++batch, now, bytes);
        now += seconds;
        estimate.acknowledged(batch, now, now);
    };
    while (now < 2) {
        deliver(4e3, 0.03);
    }
    for (double const stall : {2.0, 5.0, 20.0}) {
        deliver(16e3, stall);
        estimate.begin(16e3); // a batch that was made meanwhile
        estimate.sent(++batch, now, 16e3);
        now += 0.03;
        estimate.acknowledged(batch, now, now);
        EXPECT_TRUE(estimate.has_room(now + 0.1)) << stall;
    }
}

TEST(LinkEstimate, JitterIsNoQueue) {
    Sender sender;
    sender.run({.bits_per_second = 20e6, .delay_seconds = 0.02, .jitter_seconds = 0.04}, 8);
    EXPECT_GT(sender.used(2, 8, 2.5e6), 0.5);
    EXPECT_LT(sender.most_queueing(2, 8), 0.05);
}

TEST(LinkEstimate, WorksByOurClockAlone) {
    Sender sender;
    sender.tells_time = false;
    sender.run({.bits_per_second = 2.4e6, .delay_seconds = 0.05}, 8);
    EXPECT_LT(sender.most_queueing(2, 8), 0.07);
    EXPECT_GT(sender.used(2, 8, 300e3), 0.85);
}

TEST(LinkEstimate, WhatIsNotTheLimitIsNotFelt) {
    Sender sender;
    sender.produced = 5e6;
    sender.run({.bits_per_second = 1e9, .delay_seconds = 0.001}, 4);
    EXPECT_EQ(sender.estimate.state().bytes_per_second, std::numeric_limits<double>::infinity());
    EXPECT_GT(sender.used(1, 4, 5e6), 0.95) << "nor is the renderer held up";
}

/// Answers may tell times that no viewer's clock has.
TEST(LinkEstimate, NoAnswerBreaksIt) {
    LinkEstimate estimate;
    double const never = std::numeric_limits<double>::quiet_NaN();
    double const times[] = {5, 4, 1e13, 0, never, -1e13, std::numeric_limits<double>::infinity(), 6, 7, 7};
    double now = 100;
    std::uint64_t batch = 0;
    for (int round = 0; round < 200; ++round) {
        ++batch;
        estimate.begin(round % 3 == 0 ? 0 : 1000);
        if (round % 7 != 0) {
            estimate.sent(batch, now, round % 5 == 0 ? 0 : 900);
        }
        estimate.acknowledged(batch + 5, now, 1); // a batch that was never begun
        estimate.acknowledged(batch, now, times[round % 10]);
        estimate.acknowledged(batch, now, times[round % 10]); // again
        estimate.sent(batch, now, 900); // too late
        EXPECT_EQ(estimate.in_flight_bytes(), 0);
        EXPECT_TRUE(estimate.has_room(now + 10));
        LinkState const state = estimate.state();
        EXPECT_GT(state.bytes_per_second, 0);
        EXPECT_GE(state.bytes_per_sample, 0);
        for (double const value :
             {state.bytes_per_sample, state.delivery_seconds, state.base_seconds, estimate.window_bytes()}) {
            EXPECT_TRUE(std::isfinite(value) && value >= 0);
        }
        now += round % 4 == 0 ? 0 : 0.01;
    }
}

TEST(LinkEstimate, AnotherWayIsLearntAnew) {
    Sender sender;
    sender.run({.bits_per_second = 2e6, .delay_seconds = 0.02}, 8);
    LinkEstimate& estimate = sender.estimate;
    std::uint64_t const sent = sender.log.size();
    double const bytes_per_sample = estimate.state().bytes_per_sample;
    ASSERT_TRUE(std::isfinite(estimate.state().bytes_per_second));
    estimate.restart(sent - 3, 3);
    LinkState const state = estimate.state();
    EXPECT_FALSE(std::isfinite(state.bytes_per_second));
    EXPECT_EQ(state.bytes_per_sample, bytes_per_sample);
    EXPECT_EQ(estimate.window_bytes(), LinkEstimate().window_bytes());
    EXPECT_TRUE(estimate.has_room(20));
    for (std::uint64_t batch = sent - 2; batch <= sent; ++batch) {
        estimate.sent(batch, 20, 1000);
    }
    EXPECT_EQ(estimate.in_flight_bytes(), 3000);
    estimate.acknowledged(sent, 20.01, 1);
    EXPECT_EQ(estimate.in_flight_bytes(), 0);
}

TEST(LinkEstimate, AClockThatIsSetMakesNoQueue) {
    for (double const jump : {-3.0, 3.0}) {
        Sender sender;
        sender.jump = jump;
        sender.run({.bits_per_second = 20e6, .delay_seconds = 0.02}, 8);
        EXPECT_GT(sender.used(5, 8, 2.5e6), 0.8) << jump;
        EXPECT_LT(sender.most_queueing(5, 8), 0.07) << jump;
    }
}

/// A viewer that answers at once for a while has a window of any size. Then it stops.
TEST(LinkEstimate, WhatIsInFlightIsBounded) {
    LinkEstimate estimate;
    double now = 0;
    std::uint64_t batch = 0;
    while (estimate.window_bytes() < 4 * most_in_flight) {
        double const bytes = estimate.window_bytes();
        estimate.begin(bytes);
        estimate.sent(++batch, now, bytes);
        now += 1e-3;
        estimate.acknowledged(batch, now, std::nullopt);
        ASSERT_LT(batch, 1000u);
    }
    while (estimate.has_room(now)) {
        estimate.begin(1e6);
        estimate.sent(++batch, now, 1e6);
        ASSERT_LT(estimate.in_flight_bytes(), 4 * most_in_flight);
    }
    EXPECT_LT(estimate.in_flight_bytes(), most_in_flight + 1e6);
}

} // namespace
} // namespace framelet
