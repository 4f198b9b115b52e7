#include "server/session/session.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "fake_stream.h"
#include "server/session/limits/session_memory.h"

namespace framelet {
namespace {

TEST(Session, AFloodOfWhatAViewerEvictsIsBounded) {
    constexpr std::size_t most_waiting = std::size_t{1} << 18;
    FakeConnection const stream;
    Session::Events events;
    events.admit = [](Hello const&) { return Welcome{}; };
    events.changed = [] {};
    events.ended = [](std::string const& reason) { FAIL() << reason; };
    auto const session = std::make_shared<Session>(1, stream.stream(), events);
    session->start();
    stream->bring(Hello{protocol_version, {}, coding::all});
    Evicted const full{std::vector<SentTile>(max_evicted, {1, Tile{5}})};
    auto const waiting = [&] {
        std::vector<StreamEvent> came;
        session->take_events(came);
        return std::ranges::count_if(
            came, [](StreamEvent const& event) { return std::holds_alternative<Evicted>(event.what); });
    };
    for (std::size_t i = 0; i < 2 * most_waiting / max_evicted; ++i) {
        stream->bring(full);
    }
    EXPECT_EQ(waiting(), most_waiting / (max_evicted + 1));
    for (std::size_t i = 0; i < 2 * most_waiting; ++i) { // each is of nothing, and still takes memory
        stream->bring(Evicted{});
    }
    EXPECT_EQ(waiting(), most_waiting);
    stream->bring(full);
    EXPECT_EQ(waiting(), 1) << "what has been taken makes room";
}

/// A viewer whose server lets it in.
struct Viewed {
    FakeConnection stream;
    std::shared_ptr<Session> session;

    Viewed() {
        Session::Events events;
        events.admit = [](Hello const&) { return Welcome{}; };
        events.resize = [](Viewport, bool) { return std::nullopt; };
        events.changed = [] {};
        events.ended = [](std::string const& reason) { FAIL() << reason; };
        session = std::make_shared<Session>(1, stream.stream(), std::move(events));
    }
    /// Names what is overdue when nothing comes for so long from now on; empty: nothing is.
    std::string overdue_after(std::chrono::steady_clock::duration wait) const {
        return session->overdue(std::chrono::steady_clock::now() + wait).value_or("");
    }
};

TEST(Session, HelloCameraAndAckAreOverdueInTheirTurn) {
    Viewed viewer;
    EXPECT_EQ(viewer.overdue_after(std::chrono::hours(1)), "") << "nothing is read yet";
    viewer.session->start();
    viewer.session->start(); // the second call does nothing
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

EncodedBatch batch_of_bytes(std::uint64_t number, std::size_t bytes) {
    EncodedBatch batch;
    batch.number = number;
    batch.payload.resize(bytes);
    return batch;
}

TEST(Session, GoesOnAfterACutFromWhateverIsKept) {
    Viewed viewer;
    viewer.session->start();
    viewer.stream->bring(Hello{});
    for (std::uint64_t number = 1; number <= 5; ++number) {
        viewer.session->send_batch(batch_of_bytes(number, most_kept_bytes / 3));
    }
    viewer.stream->bring(Ack{1, 0, 0});
    EXPECT_FALSE(viewer.session->can_be_resumed(5)) << "it is open";
    viewer.session->cut();
    EXPECT_TRUE(viewer.stream->is_closed);
    EXPECT_TRUE(viewer.session->is_parked());
    viewer.session->send_batch(batch_of_bytes(6, 1)); // this one was being made
    EXPECT_FALSE(viewer.session->can_be_resumed(0)) << "it has said that it has more";
    EXPECT_FALSE(viewer.session->can_be_resumed(1)) << "that would be too much to keep";
    for (std::uint64_t const last : {3u, 4u, 5u}) {
        EXPECT_TRUE(viewer.session->can_be_resumed(last)) << last;
    }
    EXPECT_FALSE(viewer.session->can_be_resumed(6)) << "that was never sent";
    viewer.session->end("no memory left");
    EXPECT_FALSE(viewer.session->can_be_resumed(5));
}

TEST(Session, TakesOverThroughSeveralCuts) {
    Viewed first, second, third;
    for (Viewed* const viewer : {&first, &second, &third}) {
        viewer->session->start();
    }
    first.stream->bring(Hello{});
    for (std::uint64_t number = 1; number <= 3; ++number) {
        first.session->send_batch(batch_of_bytes(number, 1));
    }
    first.stream->bring(Evicted{});
    first.session->cut();
    second.session->resume(first.session, 1);
    second.stream->bring(Hello{});
    second.stream->bring(Evicted{});
    second.session->cut(); // before the loop has come to it
    EXPECT_FALSE(second.session->can_be_resumed(2)) << "it was not sent there";
    ASSERT_TRUE(second.session->can_be_resumed(1));
    third.session->resume(second.session, 1);
    EXPECT_FALSE(third.session->is_ready());
    third.stream->bring(Hello{});
    third.stream->bring(CameraUpdate{{1, Camera{}, {64, 48}}, -1});
    EXPECT_TRUE(third.session->is_ready());
    EXPECT_EQ(third.session->status().evicted, 2u);
    EXPECT_EQ(third.session->status().last_batch, 1u);
    second.session->take_over();
    third.session->take_over();
    EXPECT_EQ(third.session->status().last_batch, 3u) << "the two others are sent";
    EXPECT_FALSE(first.session->is_parked() || second.session->is_parked());
    std::vector<StreamEvent> events;
    third.session->take_events(events);
    std::vector<std::size_t> kinds;
    for (StreamEvent const& event : events) {
        kinds.push_back(event.what.index());
    }
    auto const kind = [](auto const& what) { return StreamEvent{0, what}.what.index(); };
    std::size_t const sent = kind(BatchSent{}), gone = kind(Evicted{}), resumed = kind(Resumed{});
    EXPECT_EQ(kinds, (std::vector{sent, sent, sent, gone, resumed, gone, resumed, kind(CameraUpdate{}), sent, sent}));
}

} // namespace
} // namespace framelet
