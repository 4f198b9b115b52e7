// Tests of how a viewer comes back after its session was interrupted.
#include <memory>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "tests/client/tested_core.h"

namespace framelet {
namespace {

using namespace test;

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

FakeServer::Script with_ticket(bool resumed, std::uint64_t evicted = 0) {
    FakeServer::Script script;
    script.welcome.ticket = {3, 4};
    script.welcome.resumed = resumed;
    script.welcome.evicted = evicted;
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

TEST(ClientCore, SaysOnceMoreWhatItEvictedAndTheServerHasNotHeard) {
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
    ASSERT_TRUE(viewer.server.wait_for_some<Evicted>());
    look_elsewhere();
    viewer.core->set_view({}, viewer.plane.viewport()); // so that all before it has come
    ++camera;
    ASSERT_TRUE(viewer.server.wait_for([&](std::vector<Message> const& messages) {
        auto const* const last = std::get_if<CameraUpdate>(&messages.back());
        return last != nullptr && last->view.number == camera;
    }));
    std::vector<Evicted> const told = viewer.server.received<Evicted>();
    ASSERT_GT(told.size(), 3u);
    viewer.server.cut(with_ticket(true, 2)); // it has heard two of them
    ASSERT_TRUE(viewer.is_back());
    ASSERT_TRUE(viewer.server.wait_for_some<Evicted>(2 * told.size() - 2));
    std::vector<Evicted> const all = viewer.server.received<Evicted>();
    EXPECT_TRUE(std::equal(told.begin() + 2, told.end(), all.begin() + static_cast<std::ptrdiff_t>(told.size())));
    FakeServer::Script script = with_ticket(true, told.size());
    viewer.server.cut(script);
    ASSERT_TRUE(wait_for(*viewer.core, [&] { return viewer.core->statistics().reconnections == 2; }));
    ASSERT_TRUE(viewer.server.wait_for_some<ViewerSettings>(3));
    EXPECT_EQ(viewer.server.received<Evicted>().size(), all.size()) << "it has heard all";
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

} // namespace
} // namespace framelet
