// A session of the real programs, recorded, through the same pipeline once more: the same bytes come out.
#include <csignal>
#include <thread>

#include <gtest/gtest.h>

#include "common/error.h"
#include "protocol/connection/server_address.h"
#include "server/scene/scene_import.h"
#include "tests/evaluation/codecs/link_emulator.h"
#include "tests/loopback/process.h"
#include "tests/loopback/replay.h"

namespace framelet::test {
namespace {

using namespace std::chrono_literals;

constexpr auto patience = 120s;

struct RecordedSession {
    TemporaryFolder folder;
    std::filesystem::path const file = folder.path() / "events";

    RecordedSession(std::string const& scene, std::vector<std::string> const& server_options,
                    std::vector<std::string> const& client_options, bool is_cut = false) {
        std::vector<std::string> options{"--record-events", file.string()};
        options.insert(options.end(), server_options.begin(), server_options.end());
        ServerProcess server(scene, options);
        bench::LinkEmulator link(parse_server_address(server.address()).port, {});
        std::string const address = is_cut ? "127.0.0.1:" + std::to_string(link.port()) : server.address();
        std::vector<std::string> arguments{address, "--size", "320x180", "--duration", "2"};
        arguments.insert(arguments.end(), client_options.begin(), client_options.end());
        Process client(FRAMELET_CLIENT, arguments);
        if (is_cut) {
            std::this_thread::sleep_for(1s);
            link.cut();
        }
        EXPECT_EQ(client.wait(patience), 0) << client.errors();
        server.process().signal(SIGTERM);
        EXPECT_EQ(server.process().wait(patience), 0);
    }

    std::size_t viewers() const {
        EventLogReader log(file);
        std::size_t count = 0;
        while (auto const record = log.next()) {
            count += std::holds_alternative<ViewerCame>(record->what) ? 1 : 0;
        }
        return count;
    }

    ReplayFigures replayed() const {
        EventLogReader log(file);
        std::vector<std::string> const& files = log.served().scenes;
        Scene const scene = import_scenes(std::vector<std::filesystem::path>(files.begin(), files.end()));
        RenderScene render_scene(scene, std::nullopt);
        render_scene.set_display({log.served().exposure, log.served().tone_curve});
        PosedScene posed(scene, log.served().clips, render_scene, log.served().light);
        return replay(log, posed);
    }
};

void expect_identical(ReplayFigures const& figures) {
    EXPECT_GT(figures.batches, 20u);
    EXPECT_EQ(figures.other_steps, 0u) << "after " << figures.turns << " turns";
    EXPECT_EQ(figures.other_batches, 0u) << "of " << figures.batches << ", the first is " << figures.first_other;
}

TEST(Replay, AMovingSessionIsByteIdentical) {
    RecordedSession const session(FRAMELET_SOURCE_DIR "/scenes/vehicle_chase.glb", {}, {});
    expect_identical(session.replayed());
}

TEST(Replay, SoIsOneWhoseViewerFliesThroughAStillScene) {
    TemporaryFolder const folder;
    std::string const camera = folder.write("camera.json", R"({"keys": [
        {"time": 0, "position": [9, 4, 12], "target": [0, 1, 0]},
        {"time": 1, "position": [3, 2, 9], "target": [0, 1, 0]}]})");
    RecordedSession const session(FRAMELET_SOURCE_DIR "/scenes/vehicle_fixed.glb", {"--paused"},
                                  {"--camera", camera, "--no-reprojection"});
    expect_identical(session.replayed());
}

/// The server has so many threads that it plans a batch before the last one is learnt.
TEST(Replay, SoIsOneThatLearnsWhileItRenders) {
    RecordedSession const session(FRAMELET_SOURCE_DIR "/scenes/globe.glb", {"--threads", "8"}, {});
    expect_identical(session.replayed());
}

TEST(Replay, SoIsOneOfSeveralSceneFiles) {
    RecordedSession const session(FRAMELET_SOURCE_DIR "/scenes/windmill.glb", {FRAMELET_SOURCE_DIR "/scenes/globe.glb"},
                                  {});
    expect_identical(session.replayed());
}

TEST(Replay, SoIsOneThatWasCutAndResumed) {
    RecordedSession const session(FRAMELET_SOURCE_DIR "/scenes/vehicle_chase.glb", {"--insecure"}, {}, true);
    EXPECT_EQ(session.viewers(), 1u);
    expect_identical(session.replayed());
}

TEST(Replay, WhatIsNoRecordingIsRefused) {
    TemporaryFolder const folder;
    EXPECT_THROW(EventLogReader(folder.path() / "nothing"), InputError);
    EXPECT_THROW(EventLogReader(folder.write("other", "some text\n")), InputError);
}

} // namespace
} // namespace framelet::test
