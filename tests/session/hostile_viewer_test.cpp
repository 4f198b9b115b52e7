// What one viewer sends, however odd, ends its own session at most: the others' go on.
#include <atomic>
#include <thread>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "raw_viewer.h"
#include "running_server.h"
#include "tests/protocol/unchecked_message.h"

namespace framelet {
namespace {

CameraUpdate camera_update(std::uint64_t number, Viewport viewport = {64, 48}) {
    return {{number, Camera{}, viewport}, -1};
}

/// The parameter is the number of threads: one, few, and so many that a batch is planned before the last one is learnt.
class HostileViewer : public testing::TestWithParam<std::size_t> {
    tbb::global_control const threads_{tbb::global_control::max_allowed_parallelism, GetParam()};
};
INSTANTIATE_TEST_SUITE_P(Threads, HostileViewer, testing::Values(1, 2, 8));

bool is_batch(Message const& message) {
    return std::holds_alternative<EncodedBatch>(message);
}

TEST_P(HostileViewer, SetsTheClockFarAhead) {
    RunningServer const server({}, moving_scene());
    RawViewer bystander(server.port());
    RawViewer hostile(server.port());
    for (RawViewer* const viewer : {&bystander, &hostile}) {
        viewer->send(camera_update(1));
        ASSERT_TRUE(viewer->watch(is_batch));
    }
    hostile.send(unchecked(ClockRequest{ClockRequest::time, {8e16, true, 1}}));
    EXPECT_NE(hostile.failure().find("time"), std::string::npos);
    bystander.send(camera_update(2, {48, 64}));
    EXPECT_TRUE(bystander.watch([](Message const& message) {
        auto const* const batch = std::get_if<EncodedBatch>(&message);
        return batch != nullptr && batch->moment && batch->moment->view.number == 2;
    }));
}

TEST_P(HostileViewer, LooksThroughAWindowOfNoHeight) {
    RunningServer const server;
    RawViewer bystander(server.port());
    RawViewer hostile(server.port());
    CameraUpdate update = camera_update(1);
    update.view.camera.projection = Projection::orthographic;
    update.view.camera.vertical_extent = 1e-38f;
    hostile.send(unchecked(update));
    EXPECT_NE(hostile.failure().find("camera"), std::string::npos);
    bystander.send(camera_update(1));
    EXPECT_TRUE(bystander.watch(is_batch));
}

TEST_P(HostileViewer, CamerasAtTheirBoundsAreServed) {
    RunningServer const server({}, moving_scene());
    RawViewer viewer(server.port());
    std::uint64_t number = 0;
    for (float const coordinate : {-max_camera_coordinate, 0.0f, max_camera_coordinate}) {
        for (float const extent : {least_field_of_view, most_field_of_view, least_view_height, most_view_height}) {
            Projection const projection = extent == least_field_of_view || extent == most_field_of_view
                                              ? Projection::perspective
                                              : Projection::orthographic;
            for (Viewport const viewport : {Viewport{1, 1}, Viewport{max_viewport_side, 1}, Viewport{64, 48}}) {
                CameraUpdate update = camera_update(++number, viewport);
                update.view.camera = {Vec3(coordinate), Quat(1, 0, 0, 0), projection, extent};
                viewer.send(update);
                EXPECT_TRUE(viewer.watch([&](Message const& message) {
                    auto const* const batch = std::get_if<EncodedBatch>(&message);
                    return batch != nullptr && batch->moment && batch->moment->view.number == number;
                })) << coordinate
                    << ' ' << extent << ' ' << viewport.width;
            }
        }
    }
}

TEST_P(HostileViewer, FloodsTheClock) {
    ServerOptions options;
    options.shared_control = true;
    RunningServer const server(options, moving_scene());
    RawViewer bystander(server.port());
    RawViewer hostile(server.port());
    bystander.send(camera_update(1));
    hostile.send(camera_update(1));
    ASSERT_TRUE(bystander.watch(is_batch));
    auto const start = std::chrono::steady_clock::now();
    std::atomic<int> flooded = 0;
    std::atomic<bool> goes_on = true;
    std::thread flood([&] { // it reads nothing of what is answered
        for (; flooded < 20000 || goes_on; ++flooded) {
            hostile.send(ClockRequest{ClockRequest::time, {0.001 * (flooded % 20000), true, 1}});
        }
        hostile.send(ClockRequest{ClockRequest::playing, {0, false, 1}});
        hostile.send(ClockRequest{ClockRequest::time, {7, true, 1}});
    });
    std::size_t told = 0;
    for (std::uint64_t number = 2; number < 12; ++number) {
        bystander.send(camera_update(number, {64, 40 + static_cast<int>(number)}));
        EXPECT_TRUE(bystander.watch([&](Message const& message) {
            auto const* const batch = std::get_if<EncodedBatch>(&message);
            told += std::holds_alternative<Status>(message) ? 1 : 0;
            return batch != nullptr && batch->moment && batch->moment->view.number == number;
        })) << "the bystander's pictures come while the flood lasts";
    }
    goes_on = false;
    EXPECT_TRUE(bystander.watch([&](Message const& message) {
        auto const* const status = std::get_if<Status>(&message);
        told += status != nullptr ? 1 : 0;
        return status != nullptr && status->clock.time == 7 && !status->clock.playing;
    })) << "the last of it comes through";
    std::chrono::duration<double> const elapsed = std::chrono::steady_clock::now() - start;
    EXPECT_LT(static_cast<double>(told), 60 + 150 * elapsed.count()) << "a Status for each application, and its effect";
    flood.join();
}

/// How often a viewer is told the Status while this is done, as a share of what it may be in the time that this takes.
double share_told_during(std::function<void(std::uint16_t port)> const& work) {
    ServerOptions options;
    options.paused = true;
    RunningServer const server(options, moving_scene());
    RawViewer bystander(server.port());
    auto const start = std::chrono::steady_clock::now();
    work(server.port());
    bystander.send(ClockRequest{ClockRequest::time, {7, false, 1}});
    double told = 0;
    EXPECT_TRUE(bystander.watch([&](Message const& message) {
        auto const* const status = std::get_if<Status>(&message);
        told += status != nullptr ? 1 : 0;
        return status != nullptr && status->clock.time == 7;
    }));
    std::chrono::duration<double> const elapsed = std::chrono::steady_clock::now() - start;
    return told / (3 + 11 * elapsed.count()); // the clock's, one a second of the heartbeat, and ten
}

TEST(ManyWhoComeAndGo, TakeNoOthersLink) {
    constexpr std::size_t many = 300;
    double const strangers = share_told_during([](std::uint16_t port) {
        for (std::size_t i = 0; i < many; ++i) {
            EXPECT_NE(RawViewer(port, Hello{protocol_version + 1, {}, coding::all}).failure(), "");
        }
    });
    EXPECT_LE(strangers, 1);
    double const viewers = share_told_during([](std::uint16_t port) {
        for (std::size_t i = 0; i < many; ++i) {
            EXPECT_TRUE(RawViewer(port).receive());
        }
    });
    EXPECT_LE(viewers, 1);
}

} // namespace
} // namespace framelet
