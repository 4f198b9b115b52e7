#include "server/session/session.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "fake_stream.h"
#include "server/session/limits/session_memory.h"

namespace framelet {
namespace {

constexpr std::size_t most_waiting = std::size_t{1} << 18; ///< messages and framelets that a viewer has evicted

TEST(Session, AFloodOfWhatAViewerEvictsIsBounded) {
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
    stream->bring(full);
    EXPECT_EQ(waiting(), 0) << "who was sent nothing has nothing that it could evict";
    EncodedBatch batch;
    batch.number = 1;
    session->send_batch(batch);
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

TEST(Session, WhoAsksForFilesHasLonger) {
    Viewed viewer;
    viewer.session->start();
    viewer.stream->is_browser = true;
    EXPECT_EQ(viewer.overdue_after(Session::hello_timeout + std::chrono::seconds(1)), "");
    EXPECT_NE(viewer.overdue_after(Session::files_timeout).find("Hello"), std::string::npos);
}

TEST(Session, WhoHasSpokenIsToldWhyItEnds) {
    for (bool const speaks : {false, true}) {
        FakeConnection stream;
        Session::Events events;
        events.admit = [](Hello const&) { return Welcome{}; };
        events.changed = [] {};
        std::string ended;
        events.ended = [&](std::string const& reason) { ended = reason; };
        auto const session = std::make_shared<Session>(1, stream.stream(), std::move(events));
        session->start();
        if (speaks) {
            stream->bring(Hello{});
        }
        int const before = stream->sent;
        session->end("too late", true, session->has_spoken());
        EXPECT_EQ(stream->sent - before, speaks ? 1 : 0);
        EXPECT_EQ(ended, "too late");
    }
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
    EXPECT_FALSE(second.session->take_over(*first.session)) << "the third does";
    ASSERT_TRUE(third.session->take_over(*first.session));
    EXPECT_FALSE(third.session->take_over(*first.session)) << "once";
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
    EXPECT_EQ(kinds, (std::vector{sent, sent, sent, gone, resumed, gone, kind(CameraUpdate{}), sent, sent}));
}

TEST(Session, WhoeverComesBackAgainAndAgainBeforeItsTurnLeavesOneSessionAndItsBounds) {
    Viewed first;
    first.session->start();
    first.stream->bring(Hello{});
    first.session->send_batch(batch_of_bytes(1, 1));
    auto const evict_as_much_as_is_heard = [](Viewed& viewer) {
        Evicted const full{std::vector<SentTile>(max_evicted, {1, Tile{5}})};
        for (std::size_t i = 0; i < most_waiting / max_evicted; ++i) {
            viewer.stream->bring(full);
        }
    };
    evict_as_much_as_is_heard(first);
    first.session->cut();
    std::vector<std::unique_ptr<Viewed>> returns;
    for (Session* last = first.session.get(); returns.size() < 5; last = returns.back()->session.get()) {
        ASSERT_TRUE(last->can_be_resumed(1));
        Viewed& next = *returns.emplace_back(std::make_unique<Viewed>());
        next.session->start();
        next.session->resume(last->shared_from_this(), 1);
        next.stream->bring(Hello{});
        EXPECT_EQ(next.session->earlier().get(), first.session.get());
        EXPECT_FALSE(last != first.session.get() && (last->earlier() || last->is_parked())) << "nothing is left of it";
        evict_as_much_as_is_heard(next);
        next.session->cut();
    }
    Session& last = *returns.back()->session;
    EXPECT_EQ(last.status().evicted, 6 * (most_waiting / max_evicted));
    ASSERT_TRUE(last.take_over(*first.session));
    std::vector<StreamEvent> came;
    last.take_events(came);
    std::size_t framelets = 0;
    for (StreamEvent const& event : came) {
        auto const* const gone = std::get_if<Evicted>(&event.what);
        framelets += gone != nullptr ? gone->framelets.size() : 0;
    }
    EXPECT_GT(framelets, most_waiting / 2);
    EXPECT_LE(framelets, most_waiting);
}

/// A chain of sessions would take the stack of whoever goes along it.
TEST(Session, OfVeryManyReturnsBeforeATurnNoneIsLeftButTheLast) {
    Viewed first;
    first.session->start();
    first.stream->bring(Hello{});
    first.session->cut();
    auto last = std::make_unique<Viewed>();
    last->session->resume(first.session, 0);
    std::weak_ptr<Session> const second = last->session;
    for (int times = 0; times < 100'000; ++times) {
        last->session->start();
        last->stream->bring(Hello{});
        last->session->cut();
        auto next = std::make_unique<Viewed>();
        next->session->resume(last->session, 0);
        last = std::move(next);
    }
    EXPECT_TRUE(second.expired());
    EXPECT_TRUE(last->session->take_over(*first.session));
}

TEST(Session, WhatHasBeenGivenUpIsNotTakenOver) {
    Viewed first, second;
    for (Viewed* const viewer : {&first, &second}) {
        viewer->session->start();
    }
    first.stream->bring(Hello{});
    first.session->cut();
    second.session->resume(first.session, 0);
    second.session->abandon(); // by the server's other thread, while the loop is about to take over
    EXPECT_FALSE(first.session->is_parked());
    EXPECT_FALSE(second.session->take_over(*first.session));
}

} // namespace
} // namespace framelet
