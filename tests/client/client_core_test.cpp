#include "client/core/client_core.h"

#include <atomic>
#include <random>
#include <thread>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "common/color.h"
#include "tests/client/tested_core.h"

namespace framelet {
namespace {

using namespace test;

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

/// Painting takes its time, and nothing that comes meanwhile has to wait for it.
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
    // One batch that is answered within one picture is enough; that takes a picture that takes longer than the answer.
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
    // The last camera arrives whatever was skipped before it.
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

TEST(ClientCore, BeforeTheFirstPictureItLooksFromWhereTheSceneBegins) {
    FakeServer::Script script;
    script.welcome.start_camera = look_at({3, 4, 5}, {0, 1, 0}, {0, 1, 0}, 0.7f);
    FakeServer server(script);
    ClientCore core(options_for(server));
    core.set_view({}, {32, 32}, 0);
    Picture picture;
    std::vector<PixelRect> changed;
    EXPECT_FALSE(core.update_picture(picture, changed));
    EXPECT_EQ(core.shown_camera(), script.welcome.start_camera);
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
    status.busy = 0.5f;
    server.fall_silent();
    server.send(Message(status));
    ASSERT_TRUE(wait_for(core, [&] { return core.status() == status; }));
    EXPECT_EQ(core.clock().time, 12);
    EXPECT_EQ(core.statistics().server_samples_per_second, 7e6);
    EXPECT_EQ(core.statistics().server_busy, 0.5);
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
    EXPECT_FALSE(core.statistics().converged) << "nor is that counted as it";
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
    // A batch that was still on its way for the old viewport is not shown.
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

/// Batches wait here as they do behind a window that is hidden.
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
