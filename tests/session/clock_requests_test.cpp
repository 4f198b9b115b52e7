#include "server/session/clock/clock_requests.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

using namespace std::chrono_literals;

TEST(ClockRequests, NewestOfEachFieldIsKept) {
    ClockRequests requests;
    EXPECT_TRUE(requests.add({ClockRequest::time | ClockRequest::playing, {1, false, 3}}));
    EXPECT_FALSE(requests.add({ClockRequest::time, {2, true, 4}}));
    EXPECT_FALSE(requests.add({ClockRequest::speed, {5, true, 6}}));
    WallTime const now{10s};
    EXPECT_EQ(requests.take(now),
              (ClockRequest{ClockRequest::time | ClockRequest::playing | ClockRequest::speed, {2, false, 6}}));
    EXPECT_EQ(requests.take(now).set, 0);
}

TEST(ClockRequests, OneAtATimeAndNotTooOften) {
    ClockRequests requests;
    WallTime const now{10s};
    EXPECT_TRUE(requests.add({ClockRequest::time, {1, false, 1}}));
    EXPECT_LE(requests.due(), now) << "the first is not kept waiting";
    requests.take(now);
    EXPECT_TRUE(requests.add({ClockRequest::time, {2, false, 1}}));
    EXPECT_EQ(requests.due(), now + ClockRequests::interval);
    EXPECT_FALSE(requests.add({ClockRequest::time, {3, false, 1}}));
    EXPECT_EQ(requests.take(requests.due()).state.time, 3);
}

TEST(ClockRequests, WhatSetsNothingIsNoRequest) {
    ClockRequests requests;
    EXPECT_FALSE(requests.add({0, {1, false, 1}}));
    EXPECT_TRUE(requests.add({ClockRequest::time, {1, false, 1}}));
}

} // namespace
} // namespace framelet
