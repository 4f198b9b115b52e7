// Messages with every field beyond its range, as a peer that does not check could send them.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "common/error.h"
#include "protocol/messages/message_codec.h"
#include "server/render/flush_denormals.h"
#include "unchecked_message.h"

namespace framelet {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

void expect_refused(Bytes const& body, std::string const& word) {
    try {
        decode_message(body);
        ADD_FAILURE() << "accepted, should name " << word;
    } catch (ProtocolError const& error) {
        EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
}

EncodedBatch batch_of(std::vector<Tile> tiles) {
    EncodedBatch batch;
    batch.number = 1;
    batch.tiles = std::move(tiles);
    return batch;
}

/// Expects a refusal with and without denormals: a reader must not depend on how its thread takes them.
void expect_camera_refused(void (*change)(Camera&)) {
    CameraUpdate update;
    change(update.view.camera);
    Bytes const body = unchecked(update);
    expect_refused(body, "camera");
    FlushDenormals const flush;
    expect_refused(body, "camera");
}

void expect_camera_taken(Camera const& camera) {
    Bytes const body = unchecked(CameraUpdate{{1, camera, {}}});
    EXPECT_NO_THROW(decode_message(body));
    FlushDenormals const flush;
    EXPECT_NO_THROW(decode_message(body));
}

TEST(MessageRange, Camera) {
    expect_camera_refused([](Camera& c) { c.position.x = nan; });
    expect_camera_refused([](Camera& c) { c.position.y = infinity; });
    expect_camera_refused([](Camera& c) { c.position.z = -infinity; });
    expect_camera_refused([](Camera& c) { c.position.x = 1.1e10f; });
    expect_camera_refused([](Camera& c) { c.position.z = -3e38f; });
    expect_camera_refused([](Camera& c) { c.orientation = Quat(0, 0, 0, 0); });
    expect_camera_refused([](Camera& c) { c.orientation = Quat(2, 0, 0, 0); });
    expect_camera_refused([](Camera& c) { c.orientation = Quat(1e-38f, 1e-38f, 1e-38f, 1e-38f); });
    expect_camera_refused([](Camera& c) { c.orientation.x = nan; });
    expect_camera_refused([](Camera& c) { c.projection = static_cast<Projection>(2); });
}

TEST(MessageRange, CameraLens) {
    expect_camera_refused([](Camera& c) { c.vertical_extent = 0; });
    expect_camera_refused([](Camera& c) { c.vertical_extent = -1; });
    expect_camera_refused([](Camera& c) { c.vertical_extent = 1e-38f; });
    expect_camera_refused([](Camera& c) { c.vertical_extent = 0.9e-4f; });
    expect_camera_refused([](Camera& c) { c.vertical_extent = 3.2f; });
    expect_camera_refused([](Camera& c) { c.vertical_extent = nan; });
    expect_camera_refused([](Camera& c) { c = {{}, Quat(1, 0, 0, 0), Projection::orthographic, 0}; });
    expect_camera_refused([](Camera& c) { c = {{}, Quat(1, 0, 0, 0), Projection::orthographic, 1e-38f}; });
    expect_camera_refused([](Camera& c) { c = {{}, Quat(1, 0, 0, 0), Projection::orthographic, 0.9e-4f}; });
    expect_camera_refused([](Camera& c) { c = {{}, Quat(1, 0, 0, 0), Projection::orthographic, 1.1e10f}; });
    expect_camera_refused([](Camera& c) { c = {{}, Quat(1, 0, 0, 0), Projection::orthographic, infinity}; });
}

TEST(MessageRange, CameraAtItsBounds) {
    for (float const sign : {-1.0f, 1.0f}) {
        expect_camera_taken({Vec3(sign * max_camera_coordinate), Quat(sign, 0, 0, 0)});
    }
    for (float const angle : {least_field_of_view, most_field_of_view}) {
        expect_camera_taken({{}, Quat(1, 0, 0, 0), Projection::perspective, angle});
    }
    for (float const height : {least_view_height, most_view_height}) {
        expect_camera_taken({{}, Quat(1, 0, 0, 0), Projection::orthographic, height});
    }
    expect_camera_taken({Vec3(1e-38f), Quat(1, 1e-38f, 0, 0)});
}

TEST(MessageRange, Viewport) {
    for (Viewport const bad : {Viewport{0, 1}, Viewport{1, 0}, Viewport{max_viewport_side + 1, 1},
                               Viewport{1, max_viewport_side + 1}, Viewport{65535, 65535}}) {
        CameraUpdate update;
        update.view.viewport = bad;
        expect_refused(unchecked(update), "viewport");
        EncodedBatch batch = batch_of({});
        batch.moment->view.viewport = bad;
        expect_refused(unchecked(batch), "viewport");
    }
}

TEST(MessageRange, SceneCamera) {
    for (int const bad : {-2, 4096, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()}) {
        expect_refused(unchecked(CameraUpdate{{}, bad}), "camera of the scene");
    }
}

TEST(MessageRange, ViewerSettings) {
    for (float const bad : {-16.5f, 16.5f, nan, infinity}) {
        expect_refused(unchecked(ViewerSettings{bad, 0}), "exposure");
    }
    for (float const bad : {-1.5f, 1.5f, nan, -infinity}) {
        expect_refused(unchecked(ViewerSettings{0, bad}), "bias");
    }
}

TEST(MessageRange, Clock) {
    double const bad_times[] = {-0.5, static_cast<double>(nan), static_cast<double>(infinity), 1.0000001e9, 8e16};
    for (double const bad : bad_times) {
        expect_refused(unchecked(ClockRequest{1, {bad, true, 1}}), "time");
        Status status;
        status.clock.time = bad;
        expect_refused(unchecked(status), "time");
        Welcome welcome;
        welcome.clock.time = bad;
        expect_refused(unchecked(welcome), "time");
    }
    for (float const bad : {-17.0f, 17.0f, nan}) {
        expect_refused(unchecked(ClockRequest{4, {0, true, bad}}), "speed");
    }
    expect_refused(unchecked(ClockRequest{8, {}}), "unknown field");
}

TEST(MessageRange, Status) {
    for (double const bad : {-1.0, static_cast<double>(nan), static_cast<double>(infinity)}) {
        Status status;
        status.samples_per_second = bad;
        expect_refused(unchecked(status), "samples per second");
    }
    for (float const bad : {-0.1f, 1.1f, nan}) {
        Status status;
        status.busy = bad;
        expect_refused(unchecked(status), "busy");
    }
}

TEST(MessageRange, Welcome) {
    auto const with = [](auto change) {
        Welcome welcome;
        welcome.scene_bounds.include({0, 0, 0});
        change(welcome);
        return unchecked(welcome);
    };
    expect_refused(with([](Welcome& w) { w.animation_duration = -1; }), "duration");
    expect_refused(with([](Welcome& w) { w.animation_duration = 8e16; }), "duration");
    expect_refused(with([](Welcome& w) { w.animation_duration = static_cast<double>(infinity); }), "duration");
    expect_refused(with([](Welcome& w) { w.start_camera.vertical_extent = 0; }), "camera");
    expect_refused(with([](Welcome& w) {
                       w.cameras.resize(2);
                       w.cameras[1].camera.position.x = nan;
                   }),
                   "camera");
    expect_refused(with([](Welcome& w) { w.scene_bounds.upper.x = infinity; }), "bounds");
    expect_refused(with([](Welcome& w) { w.scene_bounds.lower.y = 1; }), "bounds");
    expect_refused(with([](Welcome& w) { w.scene_bounds.upper.z = nan; }), "bounds");
}

TEST(MessageRange, TooManyCameras) {
    Builder builder;
    auto const camera = write(builder, Camera{});
    std::vector const cameras(max_scene_cameras + 1, wire::CreateSceneCamera(builder, 0, camera));
    wire::Clock const clock = write(ClockState{});
    auto const list = builder.CreateVector(cameras);
    expect_refused(finish(builder, wire::CreateWelcome(builder, 1, 0, 0, nullptr, camera, list, 0, &clock)), "4096");
}

TEST(MessageRange, Text) {
    auto const failure = [](std::string const& text) {
        Builder builder;
        return finish(builder, wire::CreateFailure(builder, builder.CreateString(text)));
    };
    expect_refused(failure(std::string(4097, 'x')), "4096");
    expect_refused(failure("two\nlines"), "one line");
    expect_refused(failure(std::string("nul\0byte", 8)), "one line");
    expect_refused(failure("\x1b[2J"), "one line");
    expect_refused(failure("\xff"), "one line");
    auto const hello = [](std::string const& text) {
        Builder builder;
        return finish(builder, wire::CreateHello(builder, 1, builder.CreateString(text)));
    };
    expect_refused(hello(std::string(4097, 'x')), "4096");
    auto const welcome = [](std::string const& server, std::string const& scene, std::string const& camera_name) {
        Builder builder;
        auto const camera = write(builder, Camera{});
        auto const named = wire::CreateSceneCamera(builder, builder.CreateString(camera_name), camera);
        wire::Clock const clock = write(ClockState{});
        auto const first = builder.CreateString(server);
        auto const second = builder.CreateString(scene);
        auto const list = builder.CreateVector(&named, 1);
        return finish(builder, wire::CreateWelcome(builder, 1, first, second, nullptr, camera, list, 0, &clock));
    };
    std::string const long_name(1025, 'x');
    expect_refused(welcome(long_name, "", ""), "1024");
    expect_refused(welcome("", long_name, ""), "1024");
    expect_refused(welcome("", "", long_name), "1024");
    EXPECT_NO_THROW(decode_message(welcome("a", "b", "c")));
}

TEST(MessageRange, Batch) {
    EncodedBatch batch = batch_of({make_tile(7, 0, 0)});
    EXPECT_NO_THROW(decode_message(unchecked(batch)));
    batch.number = 0;
    expect_refused(unchecked(batch), "number");
    batch = batch_of({});
    batch.moment->scene_time = static_cast<double>(nan);
    expect_refused(unchecked(batch), "scene time");
    batch.moment->scene_time = -1;
    expect_refused(unchecked(batch), "scene time");
    batch.moment->scene_time = 8e16;
    expect_refused(unchecked(batch), "scene time");
    batch.moment->scene_time = 0;
    batch.moment->shown_from = static_cast<double>(nan);
    expect_refused(unchecked(batch), "shown");
    batch.moment->shown_from = 8e16;
    expect_refused(unchecked(batch), "shown");
    batch.moment->shown_from = 0;
    batch.moment->view.camera.vertical_extent = 9;
    expect_refused(unchecked(batch), "camera");
}

TEST(MessageRange, Tiles) {
    expect_refused(unchecked(batch_of({make_tile(7, 0, 0), make_tile(7, 1, 0), make_tile(7, 0, 0)})), "twice");
    for (std::uint32_t const code : {0u, 2u, 0x80000000u}) {
        EXPECT_THROW(encode_message(batch_of({{code}})), UnsendableMessage) << code;
    }
}

TEST(MessageRange, Encodings) {
    auto const with = [](int encoding) {
        Builder builder;
        auto const bytes = builder.CreateVector(std::vector<std::uint8_t>{});
        return finish(builder, wire::CreateBatch(builder, 1, {}, static_cast<wire::Encoding>(encoding), bytes, bytes));
    };
    for (int const known : {1, 7, 8}) {
        EXPECT_NO_THROW(decode_message(with(known))) << known;
    }
    for (int const other : {0, 2, 3, 4, 5, 6, 9, 255}) {
        expect_refused(with(other), "encoding");
    }
}

TEST(MessageRange, WhatIsEvictedAddsUp) {
    auto const evicted = [](std::vector<std::uint64_t> const& batches, std::vector<std::uint16_t> const& counts,
                            std::vector<std::uint32_t> const& tiles) {
        Builder builder;
        return finish(builder, wire::CreateEvictedDirect(builder, &batches, &counts, &tiles));
    };
    EXPECT_NO_THROW(decode_message(evicted({1, 2}, {1, 2}, {1, 5, 6})));
    expect_refused(evicted({1, 2}, {1, 1}, {1, 5, 6}), "add up");
    expect_refused(evicted({1, 2}, {1, 3}, {1, 5, 6}), "add up");
    expect_refused(evicted({1}, {1, 2}, {1, 5, 6}), "add up");
    expect_refused(evicted({1}, {2}, {1, 8}), "tile code");
    expect_refused(evicted({1}, {4097}, std::vector<std::uint32_t>(4097, 1)), "4096");
}

TEST(MessageRange, Orders) {
    PathOrder tiles;
    tiles.view.viewport = {64, 48};
    tiles.tiles.assign(max_order_tiles, {Tile{1}, 7});
    EXPECT_NO_THROW(decode_message(unchecked(tiles)));
    auto const refuse = [](PathOrder order, void (*change)(PathOrder&), std::string const& word) {
        change(order);
        expect_refused(unchecked(order), word);
    };
    refuse(
        tiles, [](PathOrder& o) { o.scene_time = nan; }, "time");
    refuse(
        tiles, [](PathOrder& o) { o.scene_time = -1; }, "time");
    refuse(
        tiles, [](PathOrder& o) { o.display.exposure = 0; }, "exposure");
    refuse(
        tiles, [](PathOrder& o) { o.display.exposure = infinity; }, "exposure");
    refuse(
        tiles, [](PathOrder& o) { o.display.curve = static_cast<ToneCurve>(4); }, "curve");
    refuse(
        tiles, [](PathOrder& o) { o.view.viewport.width = 0; }, "viewport");
    refuse(
        tiles, [](PathOrder& o) { o.view.camera.position.x = nan; }, "camera");
    refuse(
        tiles,
        [](PathOrder& o) {
            o.tiles.push_back({Tile{1}, 0});
        },
        "more tiles");
    refuse(
        tiles, [](PathOrder& o) { o.tiles[3].tile.code = 2; }, "tile");
    refuse(
        tiles, [](PathOrder& o) { o.tiles[3].tile = make_tile(6, 0, 0); }, "tile");
    refuse(
        tiles, [](PathOrder& o) { o.places.emplace_back(); }, "both");

    PathOrder places;
    places.places.resize(max_order_places);
    places.places[1] = {~0u, {-1e10f, 0, 1e10f}, {0, 0, -1}, 1, 2, infinity};
    EXPECT_NO_THROW(decode_message(unchecked(places)));
    refuse(
        places, [](PathOrder& o) { o.places.emplace_back(); }, "places");
    refuse(
        places, [](PathOrder& o) { o.places[2].position.y = nan; }, "place");
    refuse(
        places, [](PathOrder& o) { o.places[2].position.z = 1.1e10f; }, "place");
    refuse(
        places,
        [](PathOrder& o) {
            o.places[2].normal = {0, 2, 0};
        },
        "place");
    refuse(
        places, [](PathOrder& o) { o.places[2].bright = nan; }, "place");
    refuse(
        places, [](PathOrder& o) { o.places[2].bright = -1; }, "place");
}

TEST(MessageRange, Answers) {
    PathAnswer answer{1, 2, std::vector<float>(max_order_tiles * 3 * framelet_samples)};
    Bytes const largest = unchecked(answer);
    EXPECT_NO_THROW(decode_message(largest));
    EXPECT_LE(largest.size(), max_upstream_message_bytes);
    answer.light[5] = nan;
    expect_refused(unchecked(answer), "none");
    answer.light[5] = -infinity;
    expect_refused(unchecked(answer), "none");
    answer.light.assign(max_upstream_message_bytes / sizeof(float), 0);
    expect_refused(unchecked(answer), "larger");
}

TEST(MessageRange, UnknownType) {
    for (int const type : {13, 200, 255}) {
        Builder builder;
        expect_refused(finish(builder, write(builder, Ack{}), static_cast<wire::Body>(type)), "unknown type");
    }
    Builder builder;
    expect_refused(finish(builder, write(builder, Ack{}), wire::Body::NONE), "");
}

TEST(MessageRange, WrongIdentifier) {
    Bytes body = unchecked(Ack{});
    body[4] = std::byte{'X'};
    expect_refused(body, "well-formed");
}

TEST(MessageRange, NumbersOfOwnMessagesAreChecked) {
    try {
        encode_message(ViewerSettings{nan, 0});
        ADD_FAILURE() << "encoded";
    } catch (UnsendableMessage const& error) {
        EXPECT_NE(std::string(error.what()).find("exposure"), std::string::npos) << error.what();
    }
}

} // namespace
} // namespace framelet
