// Viewers whose connection is cut and who come back: what they are sent then, and who may go on with what.
#include <algorithm>
#include <memory>
#include <thread>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "common/held/framelet_cache.h"
#include "common/picture/reconstruction.h"
#include "protocol/codec/batch_codec.h"
#include "server/scene/scene_import.h"
#include "server/session/limits/session_memory.h"
#include "tests/evaluation/codecs/link_emulator.h"
#include "tests/session/raw_viewer.h"
#include "tests/session/running_server.h"

namespace framelet {
namespace {

constexpr Viewport viewport{192, 108};

CameraUpdate camera_update(std::uint64_t number, Viewport size = viewport) {
    float const turn = 0.01f * static_cast<float>(60 - number);
    return {{number, look_at({9 + turn, 4, 12 - turn}, {0, 1, 0}, {0, 1, 0}, 0.9f), size, 1}, -1};
}

/// A viewer that keeps what it is sent when its connection is cut.
class Returning {
public:
    explicit Returning(std::uint16_t port, std::uint32_t codings = coding::exact_colour) : port_(port) {
        hello.codings = codings;
        connect();
    }

    /// Connects, after cutting the connection where there is one. False where the server does not let it in.
    bool connect() {
        connection_.reset();
        connection_ = std::make_unique<RawViewer>(port_, hello);
        auto const first = connection_->receive();
        auto const* const welcome = first ? std::get_if<Welcome>(&*first) : nullptr;
        if (welcome == nullptr) {
            return false;
        }
        is_resumed = welcome->resumed;
        controls = welcome->controls;
        evicted = welcome->evicted;
        hello.ticket = welcome->ticket;
        if (!is_resumed) {
            codec_ = BatchCodec();
            held_ = BatchMemory();
            cache_ = FrameletCache(ImagePlane(viewport));
            hello.last_batch = 0;
        }
        return true;
    }
    void look(std::uint64_t number) {
        camera_ = number;
        connection_->send(camera_update(number));
    }

    /// Takes in what comes until the picture is complete, or so many more batches have; false where it is cut before.
    bool watch(std::uint64_t most_batches = UINT64_MAX, bool answers = true) {
        while (most_batches > 0) {
            auto const message = connection_->receive();
            if (!message) {
                return false;
            }
            if (auto const* const batch = std::get_if<EncodedBatch>(&*message)) {
                take(*batch);
                --most_batches;
                if (answers) {
                    connection_->send(Ack{batch->number, 0, 0});
                }
                if (on_batch) {
                    on_batch();
                }
            } else if (auto const* const status = std::get_if<Status>(&*message)) {
                evicted = status->evicted;
                if (status->converged && status->camera_number == camera_ && status->last_batch == hello.last_batch) {
                    return true;
                }
            }
        }
        return true;
    }

    Picture picture() {
        std::vector<PixelRect> changed;
        cache_.take_changed(changed);
        Picture out(viewport.width, viewport.height);
        reconstruct_all(cache_, out);
        return out;
    }
    std::uint64_t camera() const { return camera_; }
    RawViewer& connection() { return *connection_; }
    void cut() { connection_.reset(); }
    std::unique_ptr<RawViewer> leave_open() { return std::move(connection_); }

    Hello hello; ///< what it says on the next connection
    bool is_resumed = false;
    bool controls = false; ///< its clock requests count, as its Welcome says
    std::uint64_t evicted = 0; ///< messages Evicted that have come, as the server says
    std::uint64_t framelets = 0;
    std::vector<EncodedBatch> batches;
    std::function<void()> on_batch;

private:
    void take(EncodedBatch const& batch) {
        EXPECT_EQ(batch.number, hello.last_batch + 1);
        hello.last_batch = batch.number;
        cache_.insert(codec_.decode(batch, &held_));
        framelets += batch.tiles.size();
        batches.push_back(batch);
    }

    std::uint16_t const port_;
    std::unique_ptr<RawViewer> connection_;
    std::uint64_t camera_ = 0;
    BatchCodec codec_;
    BatchMemory held_;
    FrameletCache cache_{ImagePlane(viewport)};
};

Scene chase() {
    return import_scene(FRAMELET_SOURCE_DIR "/scenes/vehicle_chase.glb");
}

ServerOptions still(std::size_t places = 8) {
    ServerOptions options;
    options.paused = true;
    options.max_sessions = places;
    return options;
}

/// The parameter is the number of threads: one, few, and so many that a batch is planned before the last one is learnt.
class Resume : public testing::TestWithParam<std::size_t> {
    tbb::global_control const threads_{tbb::global_control::max_allowed_parallelism, GetParam()};
};
INSTANTIATE_TEST_SUITE_P(Threads, Resume, testing::Values(1, 2, 8));

TEST_P(Resume, WhoHasAllIsSentNothing) {
    RunningServer const server(still(), chase());
    Returning viewer(server.port());
    EXPECT_FALSE(viewer.is_resumed);
    viewer.look(1);
    ASSERT_TRUE(viewer.watch());
    std::uint64_t const framelets = viewer.framelets;
    Picture const picture = viewer.picture();
    for (int times = 0; times < 3; ++times) {
        ASSERT_TRUE(viewer.connect());
        EXPECT_TRUE(viewer.is_resumed);
        viewer.look(1);
        ASSERT_TRUE(viewer.watch());
        EXPECT_EQ(viewer.framelets, framelets);
    }
    EXPECT_EQ(viewer.picture(), picture);
    viewer.look(2);
    ASSERT_TRUE(viewer.watch());
    EXPECT_GT(viewer.framelets, framelets);
}

TEST_P(Resume, ManyReturnsBeforeATurnAreAsOne) {
    RunningServer const server(still(), chase());
    Returning viewer(server.port());
    viewer.look(1);
    ASSERT_TRUE(viewer.watch());
    std::uint64_t const framelets = viewer.framelets;
    for (int times = 0; times < 100; ++times) {
        ASSERT_TRUE(viewer.connect());
        ASSERT_TRUE(viewer.is_resumed) << times;
    }
    viewer.look(1);
    ASSERT_TRUE(viewer.watch());
    EXPECT_EQ(viewer.framelets, framelets);
    viewer.look(2);
    ASSERT_TRUE(viewer.watch());
    EXPECT_GT(viewer.framelets, framelets);
}

TEST_P(Resume, WhatIsLackedComesOnceMoreAsItWas) {
    ServerOptions options = still();
    options.loop.stream.batch_framelets = 16;
    RunningServer const server(options, chase());
    Returning viewer(server.port());
    viewer.look(1);
    ASSERT_TRUE(viewer.watch(5));
    ASSERT_TRUE(viewer.watch(3, false)); // as if the answers were lost
    std::vector<EncodedBatch> const came = viewer.batches;
    // The other viewer comes back as if the last two batches had been lost as well.
    Returning other(server.port());
    other.hello = viewer.hello;
    other.hello.last_batch -= 2;
    ASSERT_TRUE(other.connect());
    ASSERT_TRUE(other.is_resumed);
    other.batches.clear();
    other.look(1);
    for (std::size_t i = came.size() - 2; i < came.size(); ++i) {
        auto const message = other.connection().receive();
        ASSERT_TRUE(message);
        if (std::holds_alternative<Status>(*message)) {
            --i;
            continue;
        }
        EXPECT_EQ(std::get<EncodedBatch>(*message), came[i]);
    }
}

/// A viewer comes to the exact picture however often it is cut, amid batches too.
TEST_P(Resume, CutsAmidBatchesEndInTheExactPicture) {
    RunningServer const server(still(), chase());
    Returning uncut(server.port());
    uncut.look(60);
    ASSERT_TRUE(uncut.watch());

    bench::LinkEmulator link(server.port(), {.bits_per_second = 2e6, .delay_seconds = 0.002});
    Returning viewer(link.port(), coding::exact_colour | coding::haar_colour | coding::predicted_colour);
    viewer.on_batch = [&] {
        if (viewer.camera() < 60) {
            viewer.look(viewer.camera() + 1);
        }
    };
    viewer.look(1);
    ASSERT_TRUE(viewer.watch(7));
    for (int cuts = 0; cuts < 8; ++cuts) {
        std::jthread const cut([&link, cuts] {
            std::this_thread::sleep_for(std::chrono::milliseconds(7 * cuts));
            link.cut();
        });
        while (viewer.watch(1)) {
        }
        ASSERT_TRUE(viewer.connect());
        EXPECT_TRUE(viewer.is_resumed) << cuts;
        viewer.look(viewer.camera());
        ASSERT_TRUE(viewer.watch(5));
    }
    viewer.look(60);
    ASSERT_TRUE(viewer.watch());
    EXPECT_EQ(viewer.picture(), uncut.picture());
}

TEST(ResumeTicket, OnlyTheRightOneGoesOn) {
    RunningServer const server(still(), chase());
    Returning viewer(server.port());
    viewer.look(1);
    ASSERT_TRUE(viewer.watch());
    Hello const right = viewer.hello;
    auto const is_resumed = [&](Hello const& hello) {
        Returning other(server.port(), hello.codings);
        other.hello = hello;
        EXPECT_TRUE(other.connect());
        return other.is_resumed;
    };
    for (int bit = 0; bit < 64; bit += 7) {
        Hello wrong = right;
        wrong.ticket.high ^= std::uint64_t{1} << bit;
        EXPECT_FALSE(is_resumed(wrong));
        wrong = right;
        wrong.ticket.low ^= std::uint64_t{1} << bit;
        EXPECT_FALSE(is_resumed(wrong));
    }
    Hello none = right;
    none.ticket = {};
    EXPECT_FALSE(is_resumed(none));
    viewer.look(2);
    ASSERT_TRUE(viewer.watch()) << "its own session goes on";
    EXPECT_TRUE(viewer.connect());
    EXPECT_TRUE(viewer.is_resumed);
}

/// Each of these viewers begins anew, and what was kept for the ticket is given up.
TEST(ResumeTicket, WhatDoesNotFitBeginsAnew) {
    RunningServer const server(still(), chase());
    std::uint64_t answered = 0; // the last batch that the server has heard an Ack of
    std::vector<std::function<void(Hello&)>> const changes{
        [](Hello& hello) { ++hello.last_batch; }, // a batch that was never sent
        [&](Hello& hello) { hello.last_batch = answered - 1; },
        [](Hello& hello) { hello.codings |= coding::haar_colour; },
    };
    for (auto const& change : changes) {
        Returning viewer(server.port());
        viewer.look(1);
        ASSERT_TRUE(viewer.watch());
        answered = viewer.hello.last_batch;
        viewer.look(2);
        ASSERT_TRUE(viewer.watch());
        Ticket const ticket = viewer.hello.ticket;
        change(viewer.hello);
        ASSERT_TRUE(viewer.connect());
        EXPECT_FALSE(viewer.is_resumed);
        EXPECT_NE(viewer.hello.ticket, ticket);
        viewer.look(1);
        ASSERT_TRUE(viewer.watch());
    }
}

TEST(ResumeTicket, WhoHadTheClockHasItAgain) {
    RunningServer const server(still());
    Returning first(server.port()), second(server.port());
    EXPECT_TRUE(first.controls);
    EXPECT_FALSE(second.controls);
    ASSERT_TRUE(first.connect());
    ASSERT_TRUE(first.is_resumed);
    EXPECT_TRUE(first.controls);
    ASSERT_TRUE(second.connect());
    EXPECT_FALSE(second.controls);
}

TEST(ResumeTicket, IsOfThoseWhoKnowTheSameToken) {
    ServerOptions options = still();
    options.token = "a token for all to see";
    options.control_token = "a token for the few who may";
    RunningServer const server(options);
    Hello hello{protocol_version, options.token, coding::all, {}, 0};
    auto const ticket_of = [](RawViewer& viewer) {
        return std::get<Welcome>(viewer.receive().value_or(Welcome{})).ticket;
    };
    {
        RawViewer viewer(server.port(), hello);
        hello.ticket = ticket_of(viewer);
        EXPECT_TRUE(hello.ticket);
    }
    hello.token = options.control_token;
    RawViewer controlling(server.port(), hello);
    EXPECT_NE(ticket_of(controlling), hello.ticket);
    hello.token = "no token of this server";
    RawViewer stranger(server.port(), hello);
    EXPECT_NE(stranger.failure().find("token"), std::string::npos);
}

TEST(ResumeTicket, TakesTheSessionFromAConnectionThatIsHalfOpen) {
    RunningServer const server(still(1), chase());
    Returning viewer(server.port());
    viewer.look(1);
    ASSERT_TRUE(viewer.watch());
    std::uint64_t const framelets = viewer.framelets;
    auto const half_open = viewer.leave_open();
    ASSERT_TRUE(viewer.connect());
    EXPECT_TRUE(viewer.is_resumed);
    EXPECT_EQ(half_open->failure(), "") << "it is closed without a word";
    viewer.look(1);
    ASSERT_TRUE(viewer.watch());
    EXPECT_EQ(viewer.framelets, framelets);
}

TEST(ResumeTicket, EndsWithAFarewell) {
    RunningServer const server(still(), chase());
    Returning viewer(server.port());
    viewer.look(1);
    ASSERT_TRUE(viewer.watch());
    viewer.connection().send(Failure{"enough"});
    EXPECT_EQ(viewer.connection().failure(), ""); // what had been sent before may still come
    ASSERT_TRUE(viewer.connect());
    EXPECT_FALSE(viewer.is_resumed);
}

TEST(ResumeTicket, WhoIsAwayTakesNoPlace) {
    RunningServer const server(still(1), chase());
    Returning first(server.port());
    first.look(1);
    ASSERT_TRUE(first.watch());
    Hello const hello = first.hello;
    first.cut();
    Returning second(server.port());
    while (!second.hello.ticket) { // the server has not noticed yet
        second.connect();
    }
    EXPECT_FALSE(first.connect()) << "there is another one now";
    second.connection().send(Failure{"enough"});
    while (!first.connect()) {
    }
    EXPECT_TRUE(first.is_resumed) << "it has waited for its place";
    EXPECT_EQ(first.hello.ticket, hello.ticket);
}

TEST(ResumeTicket, OfManyWhoAreAwayTheFirstAreGivenUp) {
    constexpr std::size_t places = 2;
    RunningServer const server(still(places), chase());
    std::vector<Hello> hellos;
    for (std::size_t i = 0; i < places + 1; ++i) {
        Returning viewer(server.port());
        while (!viewer.hello.ticket) { // the last one's place is not free yet
            viewer.connect();
        }
        hellos.push_back(viewer.hello);
    }
    for (std::size_t i = places + 1; i-- > 0;) {
        RawViewer viewer(server.port(), hellos[i]);
        auto const first = viewer.receive();
        ASSERT_TRUE(first);
        EXPECT_EQ(std::get<Welcome>(*first).resumed, i > 0) << i;
        viewer.send(Failure{"enough"});
        EXPECT_FALSE(viewer.receive());
    }
}

TEST(ResumeTicket, WhoIsAwayLeavesItsMemoryToOthers) {
    constexpr Viewport large{4096, 2048};
    ServerOptions options = still();
    options.session_megabytes = session_bytes(large, true) / 1'000'000 + 1;
    RunningServer const server(options);
    auto const is_batch = [](Message const& message) { return std::holds_alternative<EncodedBatch>(message); };
    Returning first(server.port(), coding::all);
    first.connection().send(camera_update(1, large));
    ASSERT_TRUE(first.connection().watch(is_batch));
    first.cut();
    for (;;) { // until the server has noticed
        RawViewer second(server.port());
        second.send(camera_update(1, large));
        if (second.watch(is_batch)) {
            break;
        }
    }
    ASSERT_TRUE(first.connect());
    EXPECT_FALSE(first.is_resumed);
}

TEST(ResumeTicket, SaysHowMuchOfWhatIsEvictedHasCome) {
    RunningServer const server(still(), chase());
    Returning viewer(server.port());
    viewer.look(1);
    ASSERT_TRUE(viewer.watch());
    Tile const tile = viewer.batches.front().tiles.front();
    for (std::uint64_t number = 1; number <= 3; ++number) {
        viewer.connection().send(Evicted{{{1, tile}}});
        viewer.look(number + 1);
        ASSERT_TRUE(viewer.watch());
        EXPECT_EQ(viewer.evicted, number);
        ASSERT_TRUE(viewer.connect());
        ASSERT_TRUE(viewer.is_resumed);
        EXPECT_EQ(viewer.evicted, number);
    }
}

} // namespace
} // namespace framelet
