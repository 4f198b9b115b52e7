#include "server/session/limits/session_memory.h"

#include <gtest/gtest.h>

#include "raw_viewer.h"
#include "running_server.h"

namespace framelet {
namespace {

constexpr Viewport large{4096, 2048}, small{640, 480};

TEST(SessionMemory, GrowsWithWhatIsHeld) {
    auto const bytes_a_pixel = [](Viewport viewport, bool predicts) {
        double const pixels = static_cast<double>(viewport.width) * viewport.height;
        return static_cast<double>(session_bytes(viewport, predicts) - session_bytes({1, 1}, predicts)) / pixels;
    };
    EXPECT_NEAR(bytes_a_pixel(large, true), 210, 15) << "as the guide says";
    EXPECT_NEAR(1e-6 * static_cast<double>(session_bytes({1, 1}, true)), 40, 3) << "as the guide says";
    EXPECT_LT(bytes_a_pixel(large, false), bytes_a_pixel(large, true) - 12);
    Viewport const largest{max_viewport_side, max_viewport_side};
    EXPECT_EQ(session_bytes(largest, true), session_bytes(largest, false)) << "too large to be predicted";
}

TEST(SessionMemory, RefusesWhatIsBeyondTheRest) {
    std::size_t const each = session_bytes(large, true);
    SessionMemory memory(2 * each + session_bytes(small, true));
    EXPECT_FALSE(memory.reserve(1, large, true));
    EXPECT_FALSE(memory.reserve(2, large, true));
    EXPECT_FALSE(memory.reserve(1, large, true)) << "the same again is no more";
    auto const refusal = memory.reserve(3, large, true);
    ASSERT_TRUE(refusal);
    EXPECT_NE(refusal->find("4096x2048"), std::string::npos) << *refusal;
    EXPECT_NE(refusal->find("--session-memory"), std::string::npos) << *refusal;
    EXPECT_FALSE(memory.reserve(3, small, true));
    memory.release(1);
    memory.release(1);
    EXPECT_FALSE(memory.reserve(3, large, true));
}

/// The scene that is loaded again may have full light, where direct light was chosen before.
TEST(SessionMemory, PixelsOfAnotherSceneMayTakeMore) {
    Viewport const viewport{256, 256};
    SessionMemory memory(session_bytes(viewport, true) + 10 * std::size_t{256 * 256});
    EXPECT_FALSE(memory.reserve(1, viewport, true));
    memory.release(1);
    memory.set_more_per_pixel(17);
    EXPECT_TRUE(memory.reserve(2, viewport, true));
}

TEST(SessionMemory, ASmallerPictureGivesNothingBack) {
    SessionMemory memory(session_bytes(large, true));
    EXPECT_FALSE(memory.reserve(1, large, true));
    EXPECT_FALSE(memory.reserve(1, small, true));
    EXPECT_TRUE(memory.reserve(2, small, true));
}

TEST(SessionMemory, WhatIsPassedOnIsCountedOnce) {
    SessionMemory memory(session_bytes(large, true));
    EXPECT_FALSE(memory.reserve(1, large, true));
    memory.pass(1, 2);
    EXPECT_FALSE(memory.reserve(2, large, true));
    memory.release(1);
    EXPECT_TRUE(memory.reserve(3, small, true));
    memory.release(2);
    EXPECT_FALSE(memory.reserve(3, small, true));
}

TEST(SessionMemory, ServerRefusesAPictureThatIsTooLargeForIt) {
    ServerOptions options;
    options.session_megabytes = session_bytes(large, true) / 1'000'000 + 1;
    RunningServer const server(options);
    RawViewer first(server.port()), second(server.port());
    CameraUpdate const update{{1, Camera{}, large}, -1};
    first.send(update);
    ASSERT_TRUE(first.watch([](Message const& message) { return std::holds_alternative<EncodedBatch>(message); }));
    second.send(update);
    EXPECT_NE(second.failure().find("ask for a smaller one"), std::string::npos);
    EXPECT_TRUE(first.watch([](Message const& message) {
        auto const* const status = std::get_if<Status>(&message);
        return status != nullptr && status->sessions == 1;
    })) << "goes on";
}

} // namespace
} // namespace framelet
