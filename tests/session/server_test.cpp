// Runs the server in this process, spoken to over loopback sockets by a viewer that sends just what a test wants.
#include "server/session/server.h"

#include <optional>
#include <thread>

#include <boost/asio/ip/tcp.hpp>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "common/error.h"
#include "protocol/stream/stream_opening.h"
#include "raw_viewer.h"
#include "running_server.h"
#include "server/session/listener.h"
#include "server/session/loaded_scene.h"

namespace framelet {
namespace {

namespace asio = boost::asio;
using namespace std::chrono_literals;

/// Runs a conversation: `answer` is called with every message and says whether to go on.
struct Conversation {
    asio::io_context io{1};
    std::shared_ptr<FramedStream> stream;
    std::string closed;

    explicit Conversation(std::uint16_t port) {
        asio::ip::tcp::socket socket(io);
        socket.connect({asio::ip::make_address("127.0.0.1"), port});
        stream = plain_stream(std::move(socket));
    }

    void run(std::function<bool(Message const&)> const& answer) {
        stream->start({[&](Message const& message) {
                           if (!answer(message)) {
                               stream->close();
                               io.stop();
                           }
                       },
                       [this](std::string const& reason) {
                           closed = reason;
                           io.stop();
                       },
                       {}},
                      max_message_bytes);
        io.run_for(60s);
    }
};

CameraUpdate camera_update(std::uint64_t number, Viewport viewport = {64, 48}) {
    return {{number, Camera{}, viewport}, -1};
}

/// The parameter is the number of threads: one, few, and so many that a batch is planned before the last one is learnt.
class ServerOfThreads : public testing::TestWithParam<std::size_t> {
    tbb::global_control const threads_{tbb::global_control::max_allowed_parallelism, GetParam()};
};
INSTANTIATE_TEST_SUITE_P(Threads, ServerOfThreads, testing::Values(1, 2, 8));

TEST_P(ServerOfThreads, CoarseFirstThenFinerThenConverged) {
    RunningServer const server;
    Conversation viewer(server.port());
    viewer.stream->send(Hello{});
    std::vector<int> depths;
    std::uint64_t newest = 0;
    bool converged = false;
    viewer.run([&](Message const& message) {
        if (auto const* const welcome = std::get_if<Welcome>(&message)) {
            EXPECT_EQ(welcome->scene_name, "triangle");
            EXPECT_EQ(welcome->animation_duration, 0);
            viewer.stream->send(camera_update(1, {640, 480}));
        } else if (auto const* const batch = std::get_if<EncodedBatch>(&message)) {
            EXPECT_EQ(batch->number, newest + 1);
            EXPECT_EQ(batch->moment.has_value(), newest == 0) << "nothing moves";
            EXPECT_TRUE(!batch->moment || batch->moment->view.number == 1);
            newest = batch->number;
            depths.push_back(batch->tiles.front().depth());
            viewer.stream->send(Ack{newest, 0, 0});
        } else if (auto const* const status = std::get_if<Status>(&message)) {
            converged = status->converged && status->last_batch == newest && newest > 0;
        }
        return !converged;
    });
    EXPECT_TRUE(converged) << viewer.closed;
    ImagePlane const plane({640, 480});
    ASSERT_FALSE(depths.empty());
    EXPECT_LT(depths.front(), plane.pixel_depth());
    EXPECT_EQ(depths.back(), plane.max_depth());
}

TEST_P(ServerOfThreads, WaitsForAcknowledgements) {
    ServerOptions options;
    options.loop.stream.batch_framelets =
        16; // so that the picture takes more batches than may be in flight, however fast
    RunningServer const server(options);
    Conversation viewer(server.port());
    viewer.stream->send(Hello{});
    std::uint64_t batches = 0, before = 0;
    int beats = 0;
    viewer.run([&](Message const& message) {
        if (std::holds_alternative<Welcome>(message)) {
            viewer.stream->send(camera_update(1, {640, 480}));
        } else if (std::holds_alternative<EncodedBatch>(message)) {
            ++batches;
        } else if (std::holds_alternative<Status>(message)) {
            beats =
                batches > 0 && batches == before ? beats + 1 : 0; // three with nothing between: time for one too many
            before = batches;
        }
        return beats < 3;
    });
    // The bytes in flight are limited as well: a busy machine may meet that limit first.
    EXPECT_LE(batches, FrameletStream::max_batches_in_flight) << "while nothing is acknowledged";
    EXPECT_GT(batches, FrameletStream::max_batches_in_flight / 4);
}

TEST(Server, NothingOlderComesFirstWhenThereIsRoomAgain) {
    // The latest camera wins without a queue to replace in: while there is no room nothing is rendered, so the first
    // batch after that is of the newest camera.
    ServerOptions options;
    options.loop.stream.batch_framelets = 16;
    RunningServer const server(options);
    Conversation viewer(server.port());
    viewer.stream->send(Hello{});
    // The room is known by its end alone, two beats with no batch between: a busy machine may meet the limit of bytes
    // in flight before that of batches.
    std::uint64_t batches = 0, before = 0;
    int beats = 0;
    enum class Until { NoRoom, CamerasArrived, NextBatch } until = Until::NoRoom;
    std::optional<std::uint64_t> next_camera;
    viewer.run([&](Message const& message) {
        if (std::holds_alternative<Welcome>(message)) {
            viewer.stream->send(camera_update(1, {640, 480}));
        } else if (auto const* const batch = std::get_if<EncodedBatch>(&message)) {
            batches = batch->number;
            EXPECT_NE(until, Until::CamerasArrived) << "without room";
            if (until == Until::NextBatch) {
                next_camera = batch->moment.value().view.number;
            }
        } else if (std::holds_alternative<Status>(message) && until != Until::NextBatch) {
            beats = batches > 0 && batches == before ? beats + 1 : 0;
            before = batches;
            if (beats == 2 && until == Until::NoRoom) {
                viewer.stream->send(camera_update(2, {640, 480}));
                viewer.stream->send(camera_update(3, {640, 480}));
                until = Until::CamerasArrived;
            } else if (beats == 4) {
                viewer.stream->send(Ack{batches, 0, 0});
                until = Until::NextBatch;
            }
        }
        return !next_camera;
    });
    EXPECT_EQ(next_camera, 3u) << viewer.closed;
}

TEST_P(ServerOfThreads, NewerCameraWinsAndLateOnesAreIgnored) {
    RunningServer const server;
    Conversation viewer(server.port());
    viewer.stream->send(Hello{});
    std::uint64_t newest = 0, camera = 0;
    bool converged = false;
    viewer.run([&](Message const& message) {
        if (std::holds_alternative<Welcome>(message)) {
            viewer.stream->send(camera_update(5, {100, 40}));
            viewer.stream->send(camera_update(4, {32, 32}));
        } else if (auto const* const batch = std::get_if<EncodedBatch>(&message)) {
            newest = batch->number;
            if (batch->moment) {
                camera = batch->moment->view.number;
                EXPECT_EQ(batch->moment->view.viewport, (Viewport{100, 40}));
            }
            EXPECT_EQ(camera, 5u);
            viewer.stream->send(Ack{newest, 0, 0});
        } else if (auto const* const status = std::get_if<Status>(&message)) {
            converged = status->converged && status->last_batch == newest && newest > 0;
        }
        return !converged;
    });
    EXPECT_TRUE(converged) << viewer.closed;
}

std::string refusal(std::uint16_t port, Message const& first) {
    Conversation viewer(port);
    viewer.stream->send(first);
    std::string text;
    viewer.run([&](Message const& message) {
        if (auto const* const failure = std::get_if<Failure>(&message)) {
            text = failure->text;
        }
        return text.empty();
    });
    return text;
}

TEST(Server, RefusesWithAReason) {
    ServerOptions options;
    options.token = "secret";
    RunningServer const server(options);
    EXPECT_NE(refusal(server.port(), Hello{}).find("token"), std::string::npos);
    EXPECT_NE(refusal(server.port(), Hello{protocol_version, "guess"}).find("token"), std::string::npos);
    EXPECT_NE(refusal(server.port(), Hello{protocol_version + 1, "secret"}).find("version"), std::string::npos);
    EXPECT_NE(refusal(server.port(), camera_update(1)).find("Hello"), std::string::npos);
}

TEST(Server, EndsTheSessionThatSpeaksOutOfTurn) {
    RunningServer const server;
    Conversation viewer(server.port());
    viewer.stream->send(Hello{});
    std::string text;
    viewer.run([&](Message const& message) {
        if (std::holds_alternative<Welcome>(message)) {
            viewer.stream->send(Status{});
        } else if (auto const* const failure = std::get_if<Failure>(&message)) {
            text = failure->text;
        }
        return text.empty();
    });
    EXPECT_FALSE(text.empty()) << viewer.closed;
}

TEST(Server, ClockRequestsReachEveryViewer) {
    ServerOptions options;
    options.shared_control = true;
    RunningServer const server(options);
    Conversation one(server.port()), two(server.port());
    std::jthread const other([&] {
        two.stream->send(Hello{});
        two.run([&](Message const& message) {
            auto const* const status = std::get_if<Status>(&message);
            return !(status && status->clock.time == 7 && !status->clock.playing);
        });
    });
    one.stream->send(Hello{});
    one.run([&](Message const& message) {
        auto const* const status = std::get_if<Status>(&message);
        if (status && status->sessions == 2 && status->clock.playing) {
            one.stream->send(ClockRequest{ClockRequest::time | ClockRequest::playing, {7, false, 1}});
        }
        return !(status && status->clock.time == 7 && !status->clock.playing);
    });
    EXPECT_TRUE(one.closed.empty()) << one.closed;
}

TEST(Server, TellsViewersHowBusyItIs) {
    RunningServer const server({}, moving_scene());
    Conversation viewer(server.port());
    viewer.stream->send(Hello{});
    bool was_busy = false;
    viewer.run([&](Message const& message) {
        if (std::holds_alternative<Welcome>(message)) {
            viewer.stream->send(camera_update(1));
        } else if (auto const* const batch = std::get_if<EncodedBatch>(&message)) {
            viewer.stream->send(Ack{batch->number, 0, 0});
        } else if (auto const* const status = std::get_if<Status>(&message)) {
            was_busy = was_busy || status->busy > 0;
            return !was_busy; // the scene moves
        }
        return true;
    });
    EXPECT_TRUE(was_busy) << viewer.closed;
}

/// Says hello and looks at the scene; returns whether it controls it, as it is told.
bool begin(RawViewer& viewer) {
    bool controls = false;
    EXPECT_TRUE(viewer.watch([&](Message const& message) {
        auto const* const welcome = std::get_if<Welcome>(&message);
        controls = welcome != nullptr && welcome->controls;
        return welcome != nullptr;
    }));
    viewer.send(camera_update(1));
    return controls;
}

ClockRequest stop_at(SceneTime time) {
    return {ClockRequest::time | ClockRequest::playing, {time, false, 1}};
}

bool hears(RawViewer& viewer, std::function<bool(Status const&)> const& wanted) {
    return viewer.watch([&](Message const& message) {
        auto const* const status = std::get_if<Status>(&message);
        return status != nullptr && wanted(*status);
    });
}

TEST(Server, OnlyTheFirstViewerSetsTheClockAndThenTheNext) {
    RunningServer const server;
    std::optional<RawViewer> first(std::in_place, server.port());
    EXPECT_TRUE(begin(*first));
    RawViewer second(server.port());
    EXPECT_FALSE(begin(second));
    second.send(stop_at(9));
    int statuses = 0;
    EXPECT_TRUE(hears(second, [&](Status const& status) {
        EXPECT_NE(status.clock.time, 9) << "one that watches has set the clock";
        return ++statuses > 2;
    }));
    first->send(stop_at(7));
    EXPECT_TRUE(hears(second, [](Status const& status) { return status.clock.time == 7 && !status.controls; }));
    first.reset();
    EXPECT_TRUE(hears(second, [](Status const& status) { return status.controls; }));
    second.send(stop_at(9));
    EXPECT_TRUE(hears(second, [](Status const& status) { return status.clock.time == 9; }));
}

TEST(Server, WhoKnowsTheTokenForItSetsTheClock) {
    ServerOptions options;
    options.token = "a token for all to see";
    options.control_token = "a token for the few who may";
    RunningServer const server(options);
    RawViewer watching(server.port(), coding::all, options.token);
    EXPECT_FALSE(begin(watching));
    RawViewer controlling(server.port(), coding::all, options.control_token);
    EXPECT_TRUE(begin(controlling));
    controlling.send(stop_at(9));
    EXPECT_TRUE(hears(watching, [](Status const& status) { return status.clock.time == 9 && !status.controls; }));
}

/// A scene may take long to be made ready, and nobody is heard while the server does so.
TEST(Server, ASceneThatReplacesAnotherIsReadyWhenItIsGiven) {
    auto const load = [](std::string const& name) {
        auto loaded = std::make_unique<LoadedScene>(triangle_scene(), std::vector<Index>{}, std::nullopt,
                                                    LookOptions{.exposure_ev = 0.0f}, [](std::string_view, double) {});
        loaded->welcome.scene_name = name;
        return loaded;
    };
    Server server(load("first"), {}, std::make_unique<Listener>("127.0.0.1", std::uint16_t{0}));
    std::jthread const running([&server] { server.run(); });
    auto const name_of_scene = [&] {
        auto const first = RawViewer(server.port()).receive();
        auto const* const welcome = first ? std::get_if<Welcome>(&*first) : nullptr;
        return welcome != nullptr ? welcome->scene_name : "";
    };
    EXPECT_EQ(name_of_scene(), "first");
    RawViewer viewer(server.port());
    ASSERT_TRUE(viewer.receive());
    server.replace_scene(load("second"));
    EXPECT_NE(viewer.failure(), "");
    EXPECT_EQ(name_of_scene(), "second");
    server.stop();
}

TEST(Server, AddressesThatCannotBeHadAreInputErrors) {
    Scene const scene = triangle_scene();
    RenderScene render_scene(scene, std::nullopt);
    PosedScene posed(scene, {}, render_scene);
    ServerOptions options;
    options.bind = "no.such.host.invalid";
    EXPECT_THROW(Server(posed, options), InputError);
    options.bind = "127.0.0.1";
    options.port = 0;
    Server const first(posed, options);
    options.port = first.port();
    EXPECT_THROW(Server(posed, options), InputError);
}

TEST(Server, KnowsWhatOnlyThisMachineReaches) {
    for (auto const* address : {"127.0.0.1", "127.8.9.1", "::1", "localhost"}) {
        EXPECT_TRUE(is_loopback(address)) << address;
    }
    for (auto const* address : {"0.0.0.0", "::", "10.0.0.1", "example.com", ""}) {
        EXPECT_FALSE(is_loopback(address)) << address;
    }
}

} // namespace
} // namespace framelet
