#include "client/core/session/server_state.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

using namespace std::chrono_literals;

ServerState::Time const start{};

Status playing(double time, float speed) {
    Status status;
    status.clock = {time, true, speed};
    status.converged = true;
    return status;
}

TEST(ServerState, ItsClockGoesOnAsItSaidLast) {
    ServerState server;
    EXPECT_FALSE(server.has_begun());
    Welcome welcome;
    welcome.clock = {1, true, 1};
    welcome.controls = false;
    server.begin(welcome, start);
    EXPECT_TRUE(server.has_begun());
    EXPECT_FALSE(server.status().controls);
    EXPECT_EQ(server.clock_at(start + 2s).time, 3);
    server.note(playing(10, -2), start + 2s);
    EXPECT_EQ(server.clock_at(start + 3s).time, 8);
    EXPECT_EQ(server.clock_at(start + 60s).time, 0) << "there is nothing before that";
    EXPECT_TRUE(server.status().converged);
}

TEST(ServerState, ItsClockStandsWhileTheSessionIsInterrupted) {
    ServerState server;
    server.note(playing(10, 1), start);
    server.stop(start + 5s);
    EXPECT_EQ(server.clock_at(start + 60s).time, 15);
    EXPECT_FALSE(server.clock_at(start + 60s).playing);
    EXPECT_FALSE(server.status().converged);
}

TEST(ServerState, WhatIsAskedOfTheClockIsTakenForGranted) {
    ServerState server;
    server.note(playing(10, 1), start);
    server.ask_clock({ClockRequest::speed, {0, false, 3}}, start + 1s);
    EXPECT_EQ(server.clock_at(start + 2s).time, 14);
    EXPECT_TRUE(server.clock_at(start + 2s).playing) << "nobody asked for that";
    EXPECT_FALSE(server.status().converged);
    server.ask_clock({ClockRequest::time | ClockRequest::playing, {4, false, 1}}, start + 2s);
    EXPECT_EQ(server.clock_at(start + 9s).time, 4);
}

} // namespace
} // namespace framelet
