#include "server/session/session.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "fake_stream.h"

namespace framelet {
namespace {

TEST(Session, AFloodOfWhatAViewerLetsGoOfIsBounded) {
    constexpr std::size_t most_waiting = std::size_t{1} << 18;
    auto const stream = std::make_shared<FakeStream>();
    Session::Events events;
    events.admit = [](Hello const&) { return Welcome{}; };
    events.changed = [] {};
    events.ended = [](std::string const& reason) { FAIL() << reason; };
    auto const session = std::make_shared<Session>(1, stream, events);
    session->start();
    stream->bring(Hello{protocol_version, {}, coding::all});
    LetGo const full{std::vector<SentTile>(max_let_go, {1, Tile{5}})};
    auto const waiting = [&] {
        std::vector<StreamEvent> came;
        session->take_events(came);
        return std::ranges::count_if(
            came, [](StreamEvent const& event) { return std::holds_alternative<LetGo>(event.what); });
    };
    for (std::size_t i = 0; i < 2 * most_waiting / max_let_go; ++i) {
        stream->bring(full);
    }
    EXPECT_EQ(waiting(), most_waiting / (max_let_go + 1));
    for (std::size_t i = 0; i < 2 * most_waiting; ++i) { // of nothing, each still takes memory
        stream->bring(LetGo{});
    }
    EXPECT_EQ(waiting(), most_waiting);
    stream->bring(full);
    EXPECT_EQ(waiting(), 1) << "what has been taken makes room";
}

/// A viewer whose server lets it in.
struct Viewed {
    std::shared_ptr<FakeStream> stream = std::make_shared<FakeStream>();
    std::shared_ptr<Session> session;

    Viewed() {
        Session::Events events;
        events.admit = [](Hello const&) { return Welcome{}; };
        events.resize = [](Viewport, bool) { return std::nullopt; };
        events.changed = [] {};
        events.ended = [](std::string const& reason) { FAIL() << reason; };
        session = std::make_shared<Session>(1, stream, std::move(events));
    }
    /// What is overdue when nothing comes for so long from now on.
    std::string overdue_after(std::chrono::steady_clock::duration wait) const {
        return session->overdue(std::chrono::steady_clock::now() + wait).value_or("");
    }
};

TEST(Session, HelloCameraAndAckAreOverdueInTheirTurn) {
    Viewed viewer;
    EXPECT_EQ(viewer.overdue_after(std::chrono::hours(1)), "") << "nothing is read yet";
    viewer.session->start();
    viewer.session->start(); // which does nothing more
    EXPECT_EQ(viewer.overdue_after({}), "");
    EXPECT_NE(viewer.overdue_after(Session::hello_timeout).find("Hello"), std::string::npos);
    viewer.stream->bring(Hello{});
    EXPECT_EQ(viewer.overdue_after({}), "");
    EXPECT_NE(viewer.overdue_after(Session::camera_timeout).find("camera"), std::string::npos);
    viewer.stream->bring(ViewerSettings{});
    EXPECT_NE(viewer.overdue_after(Session::camera_timeout).find("camera"), std::string::npos)
        << "nothing else is as good";
    viewer.stream->bring(CameraUpdate{{1, Camera{}, {64, 48}}, -1});
    EXPECT_EQ(viewer.overdue_after(std::chrono::hours(1)), "") << "it owes nothing";
    EncodedBatch batch;
    batch.number = 1;
    viewer.session->send_batch(batch);
    EXPECT_EQ(viewer.overdue_after({}), "");
    EXPECT_NE(viewer.overdue_after(Session::ack_timeout).find("acknowledging"), std::string::npos);
    viewer.stream->bring(Ack{1, 0, 0});
    EXPECT_EQ(viewer.overdue_after(std::chrono::hours(1)), "");
}

} // namespace
} // namespace framelet
