// Servers that follow the clock of another one.
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "raw_viewer.h"
#include "running_server.h"

namespace framelet {
namespace {

ServerOptions shared() {
    ServerOptions options;
    options.shared_control = true;
    return options;
}

ServerOptions following(RunningServer const& leader, ServerOptions options = shared()) {
    options.clock_from.emplace().server = {"127.0.0.1", leader.port()};
    return options;
}

ClockRequest stopped_at(double time) {
    return {ClockRequest::time | ClockRequest::playing, {time, false, 1}};
}

/// Waits for a Status of which this is true.
bool hears(RawViewer& viewer, std::function<bool(Status const&)> const& wanted) {
    return viewer.watch([&](Message const& message) {
        auto const* const status = std::get_if<Status>(&message);
        return status != nullptr && wanted(*status);
    });
}

bool begin(RawViewer& viewer) {
    auto const first = viewer.receive();
    return first && std::holds_alternative<Welcome>(*first);
}

TEST(ClockFollower, ShowsTheSameMomentAndHandsRequestsOn) {
    RunningServer const leader(shared(), moving_scene());
    RunningServer const follower(following(leader), moving_scene());
    RawViewer at_leader(leader.port()), at_follower(follower.port());
    ASSERT_TRUE(begin(at_leader) && begin(at_follower));
    at_leader.send(stopped_at(5.25));
    EXPECT_TRUE(hears(at_follower, [](Status const& s) { return s.clock.time == 5.25 && !s.clock.playing; }));
    EXPECT_TRUE(hears(at_follower, [](Status const& s) { return s.controls; }));
    at_follower.send(stopped_at(1.5));
    EXPECT_TRUE(hears(at_leader, [](Status const& s) { return s.clock.time == 1.5; }));
    EXPECT_TRUE(hears(at_follower, [](Status const& s) { return s.clock.time == 1.5; }));
    at_leader.send(ClockRequest{ClockRequest::playing | ClockRequest::speed, {0, true, 0.5f}});
    EXPECT_TRUE(hears(at_follower, [](Status const& s) { return s.clock.playing && s.clock.speed == 0.5f; }));
    EXPECT_EQ(leader.figures().sessions, 1u) << "a server that follows is no viewer";
    EXPECT_EQ(leader.figures().viewers, 1u);
}

TEST(ClockFollower, WhereTheFirstViewerControlsTheOthersViewersDoNot) {
    RunningServer const leader({}, moving_scene());
    RunningServer const follower(following(leader, {}), moving_scene());
    RawViewer at_leader(leader.port()), at_follower(follower.port());
    ASSERT_TRUE(begin(at_leader) && begin(at_follower));
    at_leader.send(stopped_at(2));
    EXPECT_TRUE(hears(at_follower, [](Status const& s) { return s.clock.time == 2 && !s.controls; }));
    at_follower.send(stopped_at(3));
    at_leader.send(stopped_at(4));
    EXPECT_TRUE(hears(at_follower, [](Status const& s) {
        EXPECT_NE(s.clock.time, 3);
        return s.clock.time == 4;
    }));
}

TEST(ClockFollower, GoesOnWithoutItsLeader) {
    auto leader = std::make_unique<RunningServer>(shared(), moving_scene());
    std::uint16_t const port = leader->port();
    RunningServer const follower(following(*leader), moving_scene());
    RawViewer viewer(follower.port());
    ASSERT_TRUE(begin(viewer));
    {
        RawViewer at_leader(port);
        ASSERT_TRUE(begin(at_leader));
        at_leader.send(stopped_at(7));
        EXPECT_TRUE(hears(viewer, [](Status const& s) { return s.clock.time == 7; }));
    }
    leader.reset();
    EXPECT_TRUE(hears(viewer, [](Status const&) { return true; })) << "it is served without a leader";
    EXPECT_EQ(follower.figures().sessions, 1u);
}

TEST(ClockFollower, WhoHearsTheClockOnlyIsToldNothingElse) {
    RunningServer const server(shared(), moving_scene());
    RawViewer listener(server.port(), coding::none);
    ASSERT_TRUE(begin(listener));
    EXPECT_TRUE(hears(listener, [](Status const&) { return true; }));
    listener.send(CameraUpdate{{1, Camera{}, {64, 48}}, -1});
    EXPECT_NE(listener.failure(), "");
    std::vector<std::unique_ptr<RawViewer>> many;
    for (int i = 0; i < 16; ++i) {
        many.push_back(std::make_unique<RawViewer>(server.port(), coding::none));
        ASSERT_TRUE(begin(*many.back())) << i;
    }
    EXPECT_NE(RawViewer(server.port(), coding::none).failure(), "");
    RawViewer viewer(server.port());
    EXPECT_TRUE(begin(viewer)) << "they take no viewer's place";
}

} // namespace
} // namespace framelet
