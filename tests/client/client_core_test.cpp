#include "client/core/client_core.h"

#include <atomic>
#include <thread>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "common/color.h"
#include "common/error.h"
#include "tests/client/fake_server.h"
#include "tests/picture/synthetic_framelets.h"

namespace framelet {
namespace {

using test::FakeServer;
using namespace std::chrono_literals;

constexpr auto patience = 60s; // nothing waits for it when all is well

ConnectionOptions options_for(FakeServer const& server) {
    ConnectionOptions out;
    out.server = server.address();
    return out;
}

/// Waits for what the core has to say until `wanted` holds.
bool wait_for(ClientCore& core, std::function<bool()> const& wanted) {
    auto const end = std::chrono::steady_clock::now() + patience;
    while (!wanted()) {
        if (std::chrono::steady_clock::now() > end) {
            return false;
        }
        core.wait_for_news(100ms);
    }
    return true;
}

/// The line that says why no session could be opened.
std::string why_not(ConnectionOptions const& options) {
    try {
        ClientCore const core(options);
    } catch (ConnectionError const& error) {
        return error.what();
    }
    return "it worked";
}

bool one_line_with(std::string const& text, std::vector<std::string> const& parts) {
    return text.find('\n') == std::string::npos && std::all_of(parts.begin(), parts.end(), [&](auto const& part) {
               return text.find(part) != std::string::npos;
           });
}

Batch constant_batch(ImagePlane const& plane, int depth, std::uint8_t value, std::uint64_t camera) {
    Batch batch = make_batch(plane, 0, {});
    batch.view.number = camera;
    for (Tile const tile : visible_tiles(plane, depth)) {
        batch.framelets.push_back(constant_framelet(plane, tile, value));
    }
    return batch;
}

TEST(ClientCore, CoarseThenFineArrivesAndIsAcknowledged) {
    FakeServer server;
    ClientCore core(options_for(server));
    EXPECT_EQ(core.welcome().scene_name, "fake scene");
    Viewport const viewport{100, 60};
    ImagePlane const plane(viewport);
    Picture picture;
    std::vector<PixelRect> changed;
    core.set_view({}, viewport);
    EXPECT_FALSE(core.update_picture(picture, changed));

    server.send(constant_batch(plane, plane.min_depth(), 50, 1));
    ASSERT_TRUE(wait_for(core, [&] { return core.update_picture(picture, changed); }));
    ASSERT_EQ(picture.width, 100);
    ASSERT_EQ(picture.height, 60);
    EXPECT_EQ(picture.row(59)[4 * 99], 50);
    EXPECT_EQ(changed, (std::vector<PixelRect>{{0, 0, 100, 60}}));

    Batch fine = make_batch(plane, 0, {constant_framelet(plane, make_tile(plane.pixel_depth(), 2, 1), 90)});
    fine.view.number = 1;
    fine.scene_time = 1; // of another moment: its neighbours stay as they are
    server.send(fine);
    ASSERT_TRUE(wait_for(core, [&] { return core.update_picture(picture, changed); }));
    EXPECT_EQ(changed, (std::vector<PixelRect>{{32, 16, 48, 32}}));
    EXPECT_EQ(picture.row(16)[4 * 32], 90);
    EXPECT_EQ(picture.row(15)[4 * 32], 50);
    EXPECT_FALSE(core.update_picture(picture, changed));

    ASSERT_TRUE(server.wait_for_some<Ack>(2));
    EXPECT_EQ(server.received<Ack>()[0].batch, 1u);
    EXPECT_EQ(server.received<Ack>()[1].batch, 2u);
    ClientStatistics const statistics = core.statistics();
    EXPECT_EQ(statistics.batches, 2u);
    EXPECT_EQ(statistics.samples, statistics.framelets * 256);
    EXPECT_EQ(statistics.coverage, 1);
    EXPECT_EQ(statistics.pictures, 2u);
    EXPECT_GT(statistics.bytes, 0u);
    EXPECT_GE(statistics.least_round_trip_seconds, 0);
    EXPECT_GE(statistics.full_picture_seconds, 0);
}

/// Painting takes its time, of which nothing that comes meanwhile has to wait for any.
TEST(ClientCore, AnswersWhileItPaints) {
    FakeServer server;
    ClientCore core(options_for(server));
    Viewport const viewport{4096, 4096};
    ImagePlane const plane(viewport);
    core.set_view({}, viewport);
    server.send(constant_batch(plane, plane.pixel_depth() - 1, 50, 1));
    ASSERT_TRUE(wait_for(core, [&] { return core.statistics().batches == 1; }));
    std::atomic<std::uint64_t> begun = 0, ended = 0; // pictures
    std::jthread const painter([&](std::stop_token const& stop) {
        Picture picture;
        std::vector<PixelRect> changed;
        for (float turned = 0; !stop.stop_requested(); turned += 0.01f) {
            Camera camera;
            camera.orientation = glm::angleAxis(turned, Vec3(0, 1, 0)); // all of it is to be painted
            core.set_view(camera, viewport);
            ++begun;
            core.update_picture(picture, changed);
            ++ended;
        }
    });
    // One batch that is answered within one picture shows it; that takes a picture that takes longer than the answer.
    bool answered_within = false;
    std::uint64_t batches = 1;
    auto const end = std::chrono::steady_clock::now() + patience;
    while (!answered_within && std::chrono::steady_clock::now() < end) {
        std::uint64_t const picture = begun;
        if (picture == ended) {
            std::this_thread::yield();
            continue;
        }
        server.send(constant_batch(plane, plane.min_depth(), 90, 1));
        ASSERT_TRUE(server.wait_for_some<Ack>(++batches));
        answered_within = begun == picture && ended + 1 == picture;
    }
    EXPECT_TRUE(answered_within);
}

TEST(ClientCore, CamerasCountUpAndEqualOnesAreNotRepeated) {
    FakeServer server;
    ClientCore core(options_for(server));
    Picture picture;
    std::vector<PixelRect> changed;
    Camera camera;
    for (int i = 1; i <= 20; ++i) {
        camera.position.x = static_cast<float>(i);
        core.set_view(camera, {64, 48}, 3);
        core.set_view(camera, {64, 48}, 3);
    }
    // The last one arrives whatever was skipped before it.
    ASSERT_TRUE(wait_for(core, [&] {
        core.update_picture(picture, changed);
        auto const cameras = server.received<CameraUpdate>();
        return !cameras.empty() && cameras.back().view.camera == camera;
    }));
    auto const cameras = server.received<CameraUpdate>();
    EXPECT_EQ(cameras.back().view.number, 20u);
    EXPECT_EQ(cameras.back().scene_camera, 3);
    for (std::size_t i = 1; i < cameras.size(); ++i) {
        EXPECT_GT(cameras[i].view.number, cameras[i - 1].view.number);
    }
}

TEST(ClientCore, SettingsAndClockRequestsGoUpAndStatusComesDown) {
    FakeServer server;
    ClientCore core(options_for(server));
    core.set_settings({1.5f, 0});
    core.request_clock({ClockRequest::time, {3.5, false, 1}});
    ASSERT_TRUE(server.wait_for_some<ClockRequest>());
    ASSERT_EQ(server.received<ViewerSettings>().size(), 1u);
    EXPECT_EQ(server.received<ViewerSettings>().front().exposure_ev, 1.5f);
    EXPECT_EQ(server.received<ClockRequest>().front().state.time, 3.5);

    Status status;
    status.clock = {12, false, 2};
    status.samples_per_second = 7e6;
    server.fall_silent();
    server.send(Message(status));
    ASSERT_TRUE(wait_for(core, [&] { return core.status() == status; }));
    EXPECT_EQ(core.clock().time, 12);
    EXPECT_EQ(core.statistics().server_samples_per_second, 7e6);
}

TEST(ClientCore, IsCompleteWhenTheNewestViewHasConvergedAndAllHasCome) {
    FakeServer server;
    server.fall_silent();
    ClientCore core(options_for(server));
    Viewport const viewport{32, 32};
    ImagePlane const plane(viewport);
    core.set_view({}, viewport);
    server.send(constant_batch(plane, plane.pixel_depth(), 1, 1));
    Status status;
    status.converged = true;
    status.camera_number = 1;
    status.last_batch = 2;
    server.send(Message(status));
    ASSERT_TRUE(wait_for(core, [&] { return core.status().converged; }));
    EXPECT_FALSE(core.is_complete()) << "batch 2 is still missing";
    server.send(constant_batch(plane, plane.pixel_depth(), 2, 1));
    EXPECT_TRUE(wait_for(core, [&] { return core.is_complete(); }));
    Camera other;
    other.position.x = 1;
    core.set_view(other, viewport);
    EXPECT_FALSE(core.is_complete()) << "that was about another view";
}

TEST(ClientCore, ANewViewportKeepsTheOldPictureUntilItsOwnContentComes) {
    FakeServer server;
    ClientCore core(options_for(server));
    ImagePlane const small(Viewport{32, 32});
    ImagePlane const large(Viewport{64, 40});
    Picture picture;
    std::vector<PixelRect> changed;
    core.set_view({}, small.viewport());
    server.send(constant_batch(small, small.pixel_depth(), 10, 1));
    ASSERT_TRUE(wait_for(core, [&] { return core.update_picture(picture, changed); }));
    core.set_view({}, large.viewport());
    EXPECT_FALSE(core.update_picture(picture, changed));
    EXPECT_EQ(picture.width, 32);
    // What was still on its way for the old one is not shown.
    server.send(constant_batch(small, small.pixel_depth(), 11, 1));
    ASSERT_TRUE(wait_for(core, [&] { return core.statistics().stale_batches == 1; }));
    EXPECT_FALSE(core.update_picture(picture, changed));
    Batch batch = constant_batch(large, large.pixel_depth(), 20, 2);
    batch.view.held_since = 2;
    server.send(batch);
    ASSERT_TRUE(wait_for(core, [&] { return core.update_picture(picture, changed); }));
    EXPECT_EQ(picture.width, 64);
    EXPECT_EQ(picture.row(39)[4 * 63], 20);
}

TEST(ClientCore, TheSameViewportOnceMoreBeginsWithNothingHeld) {
    FakeServer server;
    ClientCore core(options_for(server));
    ImagePlane const plane(Viewport{32, 32});
    Picture picture;
    std::vector<PixelRect> changed;
    core.set_view({}, plane.viewport());
    server.send(constant_batch(plane, plane.pixel_depth(), 10, 1));
    ASSERT_TRUE(wait_for(core, [&] { return core.update_picture(picture, changed); }));
    core.set_view({}, {64, 40});
    core.set_view({}, plane.viewport()); // the one between may never be sent
    EXPECT_FALSE(core.update_picture(picture, changed)) << "nothing is held";
    server.send(constant_batch(plane, plane.pixel_depth(), 11, 1));
    ASSERT_TRUE(wait_for(core, [&] { return core.statistics().stale_batches == 1; }));
    EXPECT_FALSE(core.update_picture(picture, changed)) << "it was on its way from before";
    ASSERT_TRUE(server.wait_for([](std::vector<Message> const& messages) {
        return std::ranges::any_of(messages, [](Message const& message) {
            auto const* const camera = std::get_if<CameraUpdate>(&message);
            return camera != nullptr && camera->view.held_since == 3;
        });
    }));
    Batch batch = constant_batch(plane, plane.pixel_depth(), 12, 3);
    batch.view.held_since = 3;
    server.send(batch);
    ASSERT_TRUE(wait_for(core, [&] { return core.update_picture(picture, changed); }));
    EXPECT_EQ(picture.row(31)[4 * 31], 12);
}

TEST(ClientCore, ASmoothSceneIsShownLateAndArrives) {
    FakeServer::Script script;
    script.welcome.animation_duration = 5;
    script.welcome.clock = {2, false, 1};
    FakeServer server(script);
    server.fall_silent();
    ClientCore core(options_for(server));
    core.set_smoothing(0.2);
    ImagePlane const plane(Viewport{32, 32});
    core.set_view({}, plane.viewport());
    Picture picture;
    std::vector<PixelRect> changed;
    auto const batch_at = [&](SceneTime time, std::uint8_t value) {
        Batch batch = constant_batch(plane, plane.pixel_depth(), value, 1);
        batch.scene_time = time;
        return batch;
    };
    server.send(batch_at(2, 100));
    ASSERT_TRUE(wait_for(core, [&] { return core.update_picture(picture, changed); }));
    EXPECT_EQ(picture.rgba[0], 100);
    EXPECT_EQ(core.statistics().lag_seconds, 0.2);
    core.request_clock({ClockRequest::time, {3, false, 1}});
    core.update_picture(picture, changed); // notes where the clock stands
    server.send(batch_at(3, 200));
    ASSERT_TRUE(wait_for(core, [&] { return core.statistics().batches == 2; }));
    ASSERT_TRUE(wait_for(core, [&] {
        core.update_picture(picture, changed);
        return picture.rgba[0] == 200;
    }));
    core.update_picture(picture, changed);
    EXPECT_FALSE(core.update_picture(picture, changed)) << "it has arrived";
    core.set_smoothing(0);
    EXPECT_TRUE(core.update_picture(picture, changed)) << "all of it anew";
    EXPECT_EQ(core.statistics().lag_seconds, 0);
}

/// As behind a window that is hidden.
TEST(ClientCore, WhatWaitsForAPictureIsBounded) {
    FakeServer server;
    ClientCore core(options_for(server));
    ImagePlane const plane(Viewport{32, 32});
    core.set_view({}, plane.viewport());
    Batch batch = make_batch(plane, 0, {});
    for (BodyNumber body = 1; body <= 128; ++body) {
        batch.tracks.push_back({body, 0, std::vector<BodyPose>(1024)});
    }
    constexpr std::uint64_t count = 60, bytes = 128 * 1024 * sizeof(BodyPose);
    std::uint64_t most = 0;
    for (std::uint64_t i = 1; i <= count; ++i) {
        server.send(batch);
        ASSERT_TRUE(wait_for(core, [&] { return core.statistics().batches == i; }));
        most = std::max(most, core.statistics().waiting_bytes);
    }
    EXPECT_GT(most, 10 * bytes);
    EXPECT_LT(most, count * bytes - bytes / 2);
    EXPECT_LE(most, (256u << 20) + 2 * bytes);
}

TEST(ClientCore, SaysThatNobodyListens) {
    ConnectionOptions options;
    {
        FakeServer const server;
        options = options_for(server);
    }
    std::string const text = why_not(options);
    EXPECT_TRUE(one_line_with(text, {options.server.text(), "connection refused", "framelet-server"})) << text;
}

TEST(ClientCore, SaysThatThereIsNoSuchHost) {
    ConnectionOptions options;
    options.server = {"nowhere.invalid", 7070};
    std::string const text = why_not(options);
    EXPECT_TRUE(one_line_with(text, {"nowhere.invalid:7070"})) << text;
}

TEST(ClientCore, GivesUpOnAServerThatDoesNotAnswer) {
    FakeServer::Script script;
    script.mute = true;
    FakeServer server(script);
    ConnectionOptions options = options_for(server);
    options.connect_seconds = 0.3;
    std::string const text = why_not(options);
    EXPECT_TRUE(one_line_with(text, {options.server.text(), "no answer"})) << text;
}

TEST(ClientCore, SaysWhatTheServerRefusedItFor) {
    FakeServer::Script script;
    script.refusal = "wrong token: ask whoever runs the server";
    FakeServer server(script);
    std::string const text = why_not(options_for(server));
    EXPECT_TRUE(one_line_with(text, {server.address().text(), "refused", "wrong token"})) << text;
}

TEST(ClientCore, RefusesAnotherProtocolVersion) {
    FakeServer::Script script;
    script.welcome.version = 77;
    FakeServer server(script);
    std::string const text = why_not(options_for(server));
    EXPECT_TRUE(one_line_with(text, {server.address().text(), "77", "version"})) << text;
}

TEST(ClientCore, TellsARefusalFromAServerThatIsNotThereYet) {
    FakeServer::Script script;
    script.refusal = "wrong token: ask whoever runs the server";
    ConnectionOptions options;
    {
        FakeServer server(script);
        options = options_for(server);
        EXPECT_THROW(ClientCore{options}, ConnectionRefusal);
    }
    try {
        ClientCore const core(options);
        FAIL() << "nobody listens";
    } catch (ConnectionRefusal const& error) {
        FAIL() << error.what();
    } catch (ConnectionError const&) {
    }
}

TEST(ClientCore, SendsItsTokenFirst) {
    FakeServer server;
    ConnectionOptions options = options_for(server);
    options.token = "open sesame";
    ClientCore const core(options);
    ASSERT_EQ(server.received<Hello>().size(), 1u);
    EXPECT_EQ(server.received<Hello>().front().token, "open sesame");
}

TEST(ClientCore, GarbageAndHostileLengthsEndTheConnection) {
    std::string const garbage[] = {std::string(1000, '\xff'), "HTTP/1.1 400 Bad Request\r\n\r\n",
                                   std::string("\xff\xff\xff\x7f", 4), std::string(4, '\0'),
                                   std::string("\x10\0\0\0", 4) + std::string(16, 'x')};
    for (std::string const& bytes : garbage) {
        FakeServer::Script script;
        script.raw_bytes = bytes;
        FakeServer server(script);
        ConnectionOptions options = options_for(server);
        options.connect_seconds = 30;
        std::string const text = why_not(options);
        EXPECT_TRUE(one_line_with(text, {server.address().text()})) << text;
        EXPECT_EQ(text.find("no answer"), std::string::npos) << text;
    }
}

TEST(ClientCore, ServerThatBreaksTheProtocolIsLeft) {
    FakeServer chatty;
    ClientCore core(options_for(chatty));
    chatty.send(Message(Hello{})); // only viewers say that
    ASSERT_TRUE(wait_for(core, [&] { return core.end_reason().has_value(); }));
    EXPECT_TRUE(one_line_with(*core.end_reason(), {chatty.address().text(), "protocol"})) << *core.end_reason();

    ImagePlane const plane(Viewport{32, 32});
    FakeServer broken;
    ClientCore second(options_for(broken));
    second.set_view({}, plane.viewport());
    EncodedBatch encoded =
        BatchCodec().encode(make_batch(plane, 1, {constant_framelet(plane, make_tile(plane.pixel_depth(), 0, 0), 1)}));
    encoded.payload.resize(encoded.payload.size() / 2);
    broken.send(Message(encoded));
    ASSERT_TRUE(wait_for(second, [&] { return second.end_reason().has_value(); }));
    EXPECT_TRUE(one_line_with(*second.end_reason(), {broken.address().text(), "protocol"})) << *second.end_reason();
}

TEST(ClientCore, ABatchThatNobodyAskedForIsNotShown) {
    ImagePlane const plane(Viewport{32, 32});
    FakeServer server;
    ClientCore core(options_for(server));
    server.send(constant_batch(plane, plane.pixel_depth(), 1, 1));
    ASSERT_TRUE(wait_for(core, [&] { return core.statistics().stale_batches == 1; }));
    Picture picture;
    std::vector<PixelRect> changed;
    EXPECT_FALSE(core.update_picture(picture, changed));
    EXPECT_FALSE(core.end_reason().has_value());
}

TEST(ClientCore, NoticesThatTheServerVanished) {
    FakeServer server;
    ClientCore core(options_for(server));
    server.vanish();
    ASSERT_TRUE(wait_for(core, [&] { return core.end_reason().has_value(); }));
    EXPECT_TRUE(one_line_with(*core.end_reason(), {server.address().text()})) << *core.end_reason();
    core.set_view({}, {32, 32}); // may be called still, to no effect
}

/// A viewer that comes back by itself, and has a grey picture.
struct Returning {
    FakeServer server;
    ImagePlane const plane{Viewport{100, 60}};
    std::unique_ptr<ClientCore> core;
    Picture picture;
    std::vector<PixelRect> changed;

    explicit Returning(FakeServer::Script script = {}) : server(std::move(script)) {
        ConnectionOptions options = options_for(server);
        options.reconnect = true;
        core = std::make_unique<ClientCore>(options);
        core->set_settings({2, 0, true});
        look(0);
        show(50);
        EXPECT_TRUE(server.wait_for_some<Ack>());
    }
    void look(float turned) {
        Camera camera;
        camera.orientation = glm::angleAxis(turned, Vec3(0, 1, 0));
        core->set_view(camera, plane.viewport());
    }
    void send(int depth, std::uint8_t value) { server.send(constant_batch(plane, depth, value, 1)); }
    void show(std::uint8_t value) {
        send(plane.min_depth(), value);
        EXPECT_TRUE(wait_for(*core, [&] { return update() && picture.row(30)[4 * 50] == value; }));
    }
    bool update() { return core->update_picture(picture, changed); }
    bool is_interrupted() {
        return wait_for(*core, [&] { return core->interruption().has_value(); });
    }
    bool is_back() {
        return wait_for(*core, [&] { return core->statistics().reconnections == 1 && !core->interruption(); });
    }
};

TEST(ClientCore, ComesBackAndShowsMeanwhileWhatItHolds) {
    Returning viewer;
    FakeServer::Script script;
    script.welcome.clock.playing = true;
    script.status.clock.playing = true;
    viewer.server.start_anew(script);
    ASSERT_TRUE(viewer.is_interrupted());
    EXPECT_TRUE(one_line_with(*viewer.core->interruption(), {viewer.server.address().text()}));
    EXPECT_FALSE(viewer.core->clock().playing) << "nothing of the scene is known meanwhile";
    viewer.look(0.1f);
    EXPECT_TRUE(viewer.update()) << "what is held moves with the camera";
    EXPECT_EQ(viewer.picture.row(30)[4 * 50], 50);
    ASSERT_TRUE(viewer.is_back());
    EXPECT_TRUE(viewer.core->clock().playing);
    EXPECT_FALSE(viewer.core->end_reason().has_value());
    EXPECT_EQ(viewer.core->scene_number(), 1u);
    viewer.update();
    EXPECT_EQ(viewer.picture.row(30)[4 * 50], 50) << "until there is something newer";

    ASSERT_TRUE(viewer.server.wait_for_some<ViewerSettings>(2));
    EXPECT_EQ(viewer.server.received<ViewerSettings>().back().exposure_ev, 2);
    ASSERT_TRUE(viewer.server.wait_for([](std::vector<Message> const& messages) {
        auto const* const last = std::get_if<CameraUpdate>(&messages.back());
        return last != nullptr && last->view.camera.orientation != Camera{}.orientation;
    })) << "without being asked to";
    viewer.look(0);
    viewer.show(90);
}

TEST(ClientCore, WhatIsHeldStaysUntilThereIsAWholePicture) {
    Returning viewer;
    viewer.server.start_anew({});
    ASSERT_TRUE(viewer.is_back());
    Batch part =
        make_batch(viewer.plane, 0, {constant_framelet(viewer.plane, make_tile(viewer.plane.pixel_depth(), 0, 0), 90)});
    part.view.number = 1;
    viewer.server.send(part);
    ASSERT_TRUE(viewer.server.wait_for_some<Ack>(2));
    viewer.update();
    EXPECT_EQ(viewer.picture.row(30)[4 * 50], 50);
    EXPECT_EQ(viewer.picture.row(3)[4 * 3], 50);
    viewer.show(70);
    EXPECT_EQ(viewer.picture.row(3)[4 * 3], 70);
}

TEST(ClientCore, AnotherSceneStartsClean) {
    Returning viewer;
    FakeServer::Script other;
    other.welcome.scene_identity = 8;
    other.welcome.scene_name = "another scene";
    viewer.server.start_anew(other);
    ASSERT_TRUE(viewer.is_back());
    EXPECT_EQ(viewer.core->welcome().scene_name, "another scene");
    EXPECT_EQ(viewer.core->scene_number(), 2u);
    EXPECT_TRUE(viewer.update());
    EXPECT_EQ(viewer.picture, bare_picture(viewer.plane.viewport()));
    viewer.show(90);
}

FakeServer::Script with_ticket(bool resumed, std::uint64_t let_go = 0) {
    FakeServer::Script script;
    script.welcome.ticket = {3, 4};
    script.welcome.resumed = resumed;
    script.welcome.let_go = let_go;
    return script;
}

TEST(ClientCore, GoesOnWhereItWasCut) {
    Returning viewer(with_ticket(false));
    EXPECT_FALSE(viewer.server.received<Hello>().front().ticket);
    viewer.server.cut(with_ticket(true));
    ASSERT_TRUE(viewer.is_back());
    Hello const hello = viewer.server.received<Hello>().back();
    EXPECT_EQ(hello.ticket, (Ticket{3, 4}));
    EXPECT_EQ(hello.last_batch, 1u);
    EXPECT_EQ(viewer.core->scene_number(), 1u);
    Batch part =
        make_batch(viewer.plane, 0, {constant_framelet(viewer.plane, make_tile(viewer.plane.pixel_depth(), 0, 0), 90)});
    part.view.number = 1;
    viewer.server.send(part);
    ASSERT_TRUE(wait_for(*viewer.core, [&] { return viewer.update() && viewer.picture.row(3)[4 * 3] == 90; }))
        << "what comes joins what is held";
    EXPECT_EQ(viewer.picture.row(30)[4 * 50], 50);
    ASSERT_TRUE(viewer.server.wait_for_some<Ack>(2));
    viewer.server.cut(with_ticket(true));
    ASSERT_TRUE(viewer.server.wait_for_some<Hello>(3));
    EXPECT_EQ(viewer.server.received<Hello>().back().last_batch, 2u);
}

TEST(ClientCore, BeginsAnewWhereTheServerDoesNotGoOn) {
    Returning viewer(with_ticket(false));
    viewer.server.start_anew(with_ticket(false));
    ASSERT_TRUE(viewer.is_back());
    EXPECT_TRUE(viewer.server.received<Hello>().back().ticket);
    viewer.show(70);
    viewer.server.cut(with_ticket(true));
    ASSERT_TRUE(viewer.server.wait_for_some<Hello>(3));
    EXPECT_EQ(viewer.server.received<Hello>().back().last_batch, 1u) << "of the newest session";
}

TEST(ClientCore, LeavesAServerThatGoesOnUnasked) {
    Returning viewer;
    viewer.server.cut(with_ticket(true));
    ASSERT_TRUE(wait_for(*viewer.core, [&] { return viewer.core->end_reason().has_value(); }));
    EXPECT_TRUE(one_line_with(*viewer.core->end_reason(), {"protocol"})) << *viewer.core->end_reason();
}

TEST(ClientCore, SaysOnceMoreWhatItLetGoAndTheServerHasNotHeard) {
    Returning viewer(with_ticket(false));
    std::uint64_t camera = 1;
    auto const look_elsewhere = [&] {
        for (std::size_t i = 0; i < FrameletPool::most_moments; ++i) {
            viewer.look(0.01f * static_cast<float>(++camera));
            Batch batch = constant_batch(viewer.plane, viewer.plane.min_depth(), 70, camera);
            batch.view.camera.position.x = static_cast<float>(camera);
            viewer.server.send(std::move(batch));
            EXPECT_TRUE(wait_for(*viewer.core, [&] { return viewer.core->statistics().batches == camera; }));
            viewer.update();
        }
    };
    look_elsewhere();
    ASSERT_TRUE(viewer.server.wait_for_some<LetGo>());
    look_elsewhere();
    viewer.core->set_view({}, viewer.plane.viewport()); // so that all before it has come
    ++camera;
    ASSERT_TRUE(viewer.server.wait_for([&](std::vector<Message> const& messages) {
        auto const* const last = std::get_if<CameraUpdate>(&messages.back());
        return last != nullptr && last->view.number == camera;
    }));
    std::vector<LetGo> const told = viewer.server.received<LetGo>();
    ASSERT_GT(told.size(), 3u);
    viewer.server.cut(with_ticket(true, 2)); // it has heard two of them
    ASSERT_TRUE(viewer.is_back());
    ASSERT_TRUE(viewer.server.wait_for_some<LetGo>(2 * told.size() - 2));
    std::vector<LetGo> const all = viewer.server.received<LetGo>();
    EXPECT_TRUE(std::equal(told.begin() + 2, told.end(), all.begin() + static_cast<std::ptrdiff_t>(told.size())));
    FakeServer::Script script = with_ticket(true, told.size());
    viewer.server.cut(script);
    ASSERT_TRUE(wait_for(*viewer.core, [&] { return viewer.core->statistics().reconnections == 2; }));
    ASSERT_TRUE(viewer.server.wait_for_some<ViewerSettings>(3));
    EXPECT_EQ(viewer.server.received<LetGo>().size(), all.size()) << "it has heard all";
}

TEST(ClientCore, SaysFarewell) {
    FakeServer server;
    { ClientCore const core(options_for(server)); }
    ASSERT_TRUE(server.wait_for_some<Failure>());
}

TEST(ClientCore, ARefusalIsFinalUnlessItSaysOtherwise) {
    Returning viewer;
    FakeServer::Script full;
    full.refusal = "no room";
    full.refusal_again = true;
    viewer.server.start_anew(full);
    ASSERT_TRUE(viewer.is_interrupted());
    ASSERT_TRUE(viewer.server.wait_for_some<Hello>(3));
    EXPECT_FALSE(viewer.core->end_reason().has_value());
    viewer.server.start_anew({});
    ASSERT_TRUE(viewer.is_back());
    FakeServer::Script strict;
    strict.refusal = "wrong token";
    viewer.server.start_anew(strict);
    ASSERT_TRUE(wait_for(*viewer.core, [&] { return viewer.core->end_reason().has_value(); }));
    EXPECT_TRUE(one_line_with(*viewer.core->end_reason(), {"wrong token"})) << *viewer.core->end_reason();
    EXPECT_FALSE(viewer.core->interruption().has_value());
}

TEST(ClientCore, OneThatOnlyWatchesLeavesTheClockAlone) {
    FakeServer::Script script;
    script.welcome.controls = false;
    script.heartbeat_seconds = 0;
    FakeServer server(script);
    ClientCore core(options_for(server));
    EXPECT_FALSE(core.controls());
    core.request_clock({ClockRequest::playing, {0, true, 1}});
    server.send(Message(Status{}));
    ASSERT_TRUE(wait_for(core, [&] { return core.controls(); }));
    core.request_clock({ClockRequest::time, {5, false, 1}});
    ASSERT_TRUE(server.wait_for_some<ClockRequest>());
    EXPECT_EQ(server.received<ClockRequest>().front().set, ClockRequest::time);
}

TEST(ClientCore, NoticesThatTheServerFellSilent) {
    FakeServer server;
    ConnectionOptions options = options_for(server);
    options.silence_seconds = 1;
    ClientCore core(options);
    core.wait_for_news(1500ms); // heartbeats keep it
    EXPECT_FALSE(core.end_reason().has_value());
    server.fall_silent();
    ASSERT_TRUE(wait_for(core, [&] { return core.end_reason().has_value(); }));
    EXPECT_TRUE(one_line_with(*core.end_reason(), {server.address().text(), "stopped answering"}));
}

TEST(ClientCore, PassesOnWhyTheServerEndedTheSession) {
    FakeServer server;
    ClientCore core(options_for(server));
    server.send(Message(Failure{"the server is shutting down"}));
    ASSERT_TRUE(wait_for(core, [&] { return core.end_reason().has_value(); }));
    EXPECT_TRUE(one_line_with(*core.end_reason(), {server.address().text(), "shutting down"})) << *core.end_reason();
}

TEST(ClientCore, ManyBatchesWhileAnotherThreadDraws) {
    FakeServer server;
    ClientCore core(options_for(server));
    ImagePlane const plane(Viewport{160, 90});
    core.set_view({}, plane.viewport());
    std::mt19937 random(5);
    constexpr std::uint64_t count = 150;
    for (std::uint64_t i = 0; i < count; ++i) {
        Batch batch =
            constant_batch(plane, plane.min_depth() + static_cast<int>(i % 5), static_cast<std::uint8_t>(i), 1);
        batch.framelets.resize(std::min<std::size_t>(batch.framelets.size(), 40));
        server.send(batch);
    }
    Picture picture;
    std::vector<PixelRect> changed;
    ASSERT_TRUE(wait_for(core, [&] {
        core.update_picture(picture, changed);
        return core.statistics().batches == count;
    }));
    core.update_picture(picture, changed);
    EXPECT_EQ(picture.row(0)[0], count - 1);
}

} // namespace
} // namespace framelet
