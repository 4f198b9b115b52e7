// The real server, a viewer's core, and a link between them that is cut: what is sent after that, and what is seen.
#include <csignal>
#include <memory>
#include <optional>
#include <thread>

#include <gtest/gtest.h>

#include "client/core/client_core.h"
#include "tests/evaluation/codecs/link_emulator.h"
#include "tests/loopback/process.h"

namespace framelet::test {
namespace {

using namespace std::chrono_literals;

constexpr Viewport viewport{320, 180};
std::string const scene_file = FRAMELET_SOURCE_DIR "/scenes/vehicle_chase.glb";

std::uint16_t port_of(std::string const& address) {
    return parse_server_address(address).port;
}

class Viewer {
public:
    explicit Viewer(std::uint16_t port) {
        ConnectionOptions options;
        options.server = {"127.0.0.1", port};
        options.reconnect = true;
        core = std::make_unique<ClientCore>(options);
    }

    void look(float x) { core->set_view(look_at({x, 4, 12}, {0, 1, 0}, {0, 1, 0}, 0.9f), viewport); }
    bool wait_until(std::function<bool()> const& wanted) {
        std::vector<PixelRect> changed;
        auto const end = std::chrono::steady_clock::now() + 100s;
        while (!wanted()) {
            core->update_picture(picture, changed);
            if (std::chrono::steady_clock::now() > end || core->end_reason()) {
                return false;
            }
            core->wait_for_news(20ms);
        }
        core->update_picture(picture, changed);
        return true;
    }
    bool come_to_rest() {
        return wait_until([this] { return core->is_complete(); });
    }
    bool come_back(std::uint64_t times) {
        return wait_until([&] { return core->statistics().reconnections >= times && !core->interruption(); });
    }

    std::unique_ptr<ClientCore> core;
    Picture picture;
};

struct Resumption : testing::Test {
    ServerProcess server{scene_file, {"--paused", "--exposure", "0", "--insecure"}};
    bench::LinkEmulator link{port_of(server.address()), {.bits_per_second = 6e6, .delay_seconds = 0.002}};

    /// The final picture of a viewer that nothing happens to.
    Picture uncut(float x) const {
        Viewer viewer(port_of(server.address()));
        viewer.look(x);
        EXPECT_TRUE(viewer.come_to_rest());
        return viewer.picture;
    }
};

TEST_F(Resumption, OfAPictureAtRestNothingIsSentOnceMore) {
    Viewer viewer(link.port());
    viewer.look(9);
    ASSERT_TRUE(viewer.come_to_rest());
    auto const before = viewer.core->statistics();
    ASSERT_GT(before.framelets, 0u);
    link.cut();
    ASSERT_TRUE(viewer.come_back(1));
    ASSERT_TRUE(viewer.come_to_rest());
    EXPECT_EQ(viewer.core->statistics().framelets, before.framelets);
    EXPECT_EQ(viewer.picture, uncut(9));
    viewer.look(8.5);
    ASSERT_TRUE(viewer.come_to_rest()) << "it goes on";
    EXPECT_EQ(viewer.picture, uncut(8.5));
}

TEST_F(Resumption, WhatIsLostAmidABatchComesOnce) {
    Viewer viewer(link.port());
    std::uint64_t cuts = 0;
    for (float x = 9; cuts < 6; x -= 0.25f) {
        viewer.look(x);
        ASSERT_TRUE(viewer.wait_until([&, batches = viewer.core->statistics().batches] {
            return viewer.core->statistics().batches > batches + cuts;
        }));
        link.cut();
        ASSERT_TRUE(viewer.come_back(++cuts));
    }
    viewer.look(9);
    ASSERT_TRUE(viewer.come_to_rest());
    EXPECT_EQ(viewer.core->statistics().batches, viewer.core->status().last_batch) << "each of one long session, once";
    EXPECT_EQ(viewer.picture, uncut(9));
}

TEST_F(Resumption, OfAMovingSceneItGoesOnToo) {
    ServerProcess const moving{scene_file, {"--exposure", "0", "--insecure"}};
    bench::LinkEmulator moving_link{port_of(moving.address()), {.bits_per_second = 6e6, .delay_seconds = 0.002}};
    Viewer viewer(moving_link.port());
    viewer.look(9);
    for (std::uint64_t cuts = 1; cuts <= 4; ++cuts) {
        ASSERT_TRUE(viewer.wait_until([&, batches = viewer.core->statistics().batches] {
            return viewer.core->statistics().batches > batches + 20;
        }));
        moving_link.cut();
        ASSERT_TRUE(viewer.come_back(cuts));
    }
    viewer.core->request_clock({ClockRequest::time | ClockRequest::playing, {0, false, 1}});
    ASSERT_TRUE(viewer.wait_until(
        [&] { return viewer.core->status().clock.time == 0 && !viewer.core->status().clock.playing; }));
    ASSERT_TRUE(viewer.come_to_rest());
    EXPECT_EQ(viewer.core->statistics().batches, viewer.core->status().last_batch);
    EXPECT_EQ(viewer.picture, uncut(9));
}

TEST_F(Resumption, AnotherServerBeginsAnew) {
    Picture const whole = uncut(9);
    std::uint16_t const port = port_of(server.address());
    Viewer viewer(port);
    viewer.look(9);
    ASSERT_TRUE(viewer.come_to_rest());
    auto const before = viewer.core->statistics();
    server.process().signal(SIGKILL);
    server.process().wait(10s);
    ServerProcess const next = ServerProcess::of_program(
        FRAMELET_SERVER, {scene_file, "--paused", "--exposure", "0", "--insecure", "--port", std::to_string(port)});
    ASSERT_TRUE(viewer.come_back(1));
    ASSERT_TRUE(viewer.come_to_rest());
    EXPECT_GT(viewer.core->statistics().framelets, before.framelets);
    EXPECT_EQ(viewer.picture, whole);
}

} // namespace
} // namespace framelet::test
