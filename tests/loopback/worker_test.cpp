// A server whose paths of light are traced by other processes too: what viewers get is what one process makes, whatever
// becomes of the others.
#include <csignal>
#include <thread>

#include <gtest/gtest.h>

#include "server/scene/scene_import.h"
#include "tests/loopback/metrics_page.h"
#include "tests/loopback/process.h"
#include "tests/loopback/replay.h"
#include "tests/loopback/shown_frames.h"

namespace framelet::test {
namespace {

using namespace std::chrono_literals;

constexpr auto patience = 120s;
std::string const scene_file = FRAMELET_SOURCE_DIR "/scenes/windmill.glb";

/// A server that records what it makes, and its workers.
class WorkedServer {
public:
    explicit WorkedServer(std::string const& light, std::vector<std::string> options = {})
        : server_(scene_file, with({"--light", light, "--threads", "1", "--metrics", "0", "--record-events", events()},
                                   std::move(options))),
          metrics_(metrics_address(server_)) {}

    static std::unique_ptr<Process> worker(std::string const& address, std::vector<std::string> options = {}) {
        return std::make_unique<Process>(
            FRAMELET_SERVER, with({scene_file, "--work-for", address, "--threads", "1"}, std::move(options)));
    }
    std::string const& address() const { return server_.address(); }
    bool has_workers(int count) {
        return eventually([&] { return figure("framelet_workers") == count; });
    }
    double figure(std::string const& name) { return metric(ask(metrics_, "/metrics").body(), name); }
    void end() {
        server_.process().signal(SIGTERM);
        EXPECT_EQ(server_.process().wait(patience), 0) << server_.process().errors();
    }
    std::string log() { return server_.process().errors(); }

    /// The same events through a pipeline in this process, alone.
    ReplayFigures replayed() const {
        EventLogReader log(events());
        Scene const scene = import_scenes(std::vector<std::filesystem::path>{scene_file});
        RenderScene render_scene(scene, std::nullopt);
        render_scene.set_display({log.served().exposure, log.served().tone_curve});
        PosedScene posed(scene, log.served().clips, render_scene, log.served().light);
        return replay(log, posed);
    }

private:
    static std::vector<std::string> with(std::vector<std::string> options, std::vector<std::string> more) {
        options.insert(options.end(), more.begin(), more.end());
        return options;
    }
    std::string events() const { return (folder_.path() / "events").string(); }

    TemporaryFolder folder_;
    ServerProcess server_;
    std::string metrics_;
};

void look(WorkedServer& server) {
    Process client(FRAMELET_CLIENT, {server.address(), "--size", "160x90", "--duration", "2"});
    EXPECT_EQ(client.wait(patience), 0) << client.errors();
}

void expect_bytes_of_one_process(WorkedServer& server) {
    server.end();
    ReplayFigures const figures = server.replayed();
    EXPECT_GT(figures.batches, 20u);
    EXPECT_EQ(figures.other_steps, 0u) << "after " << figures.turns << " turns";
    EXPECT_EQ(figures.other_batches, 0u) << "of " << figures.batches << ", the first is " << figures.first_other;
}

TEST(Workers, OneMakesTheBytesOfOneProcess) {
    WorkedServer server("reference");
    auto const worker = WorkedServer::worker(server.address());
    ASSERT_TRUE(server.has_workers(1)) << worker->errors();
    look(server);
    EXPECT_GT(server.figure("framelet_worker_paths_total"), 0);
    expect_bytes_of_one_process(server);
    worker->signal(SIGTERM);
    EXPECT_EQ(worker->wait(patience), 0) << "it looks for the server again until it is told to end";
}

TEST(Workers, SoDoThreeOneOfWhichIsKilledAndOneStopped) {
    WorkedServer server("reference");
    std::vector<std::unique_ptr<Process>> workers;
    for (int i = 0; i < 3; ++i) {
        workers.push_back(WorkedServer::worker(server.address()));
    }
    ASSERT_TRUE(server.has_workers(3)) << workers[0]->errors();
    TemporaryFolder const folder;
    Process client(FRAMELET_CLIENT, {server.address(), "--size", "160x90", "--duration", "1000", "--frames",
                                     (folder.path() / "frames.json").string()});
    auto const samples = [&] {
        auto const shown = shown_in(folder.read("frames.json"));
        return shown.empty() ? 0 : shown.back().samples;
    };
    ASSERT_TRUE(eventually([&] { return samples() > 0; })) << client.errors();
    std::this_thread::sleep_for(1s);
    double const hurt = std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
    workers[0]->signal(SIGSTOP);
    std::this_thread::sleep_for(1s);
    workers[1]->signal(SIGKILL);
    EXPECT_TRUE(server.has_workers(2));
    double const before = samples();
    EXPECT_TRUE(eventually([&] { return samples() > before; })) << "pictures go on";
    std::this_thread::sleep_for(1s);
    client.signal(SIGTERM);
    EXPECT_EQ(client.wait(patience), 0) << client.errors();
    std::printf("the longest time without a new sample: %.2f s\n",
                longest_gap(shown_in(folder.read("frames.json")), hurt));
    workers[0]->signal(SIGCONT);
    expect_bytes_of_one_process(server);
}

TEST(Workers, ThoseOfAnMpiJobAreWorkersLikeOthers) {
    std::string const mpirun = "/usr/bin/mpirun";
    if (!std::filesystem::exists(mpirun)) {
        GTEST_SKIP() << "there is no " << mpirun;
    }
    WorkedServer server("reference");
    Process job(mpirun, {"--allow-run-as-root", "--oversubscribe", "-n", "3", FRAMELET_SERVER, scene_file, "--work-for",
                         server.address(), "--threads", "1"});
    ASSERT_TRUE(server.has_workers(3)) << job.errors();
    look(server);
    EXPECT_GT(server.figure("framelet_worker_paths_total"), 0);
    expect_bytes_of_one_process(server);
    job.signal(SIGTERM);
    job.wait(patience);
}

TEST(Workers, TheyGatherLightWhileNobodyLooks) {
    WorkedServer server("full");
    auto const worker = WorkedServer::worker(server.address());
    EXPECT_TRUE(eventually([&] { return server.figure("framelet_worker_paths_total") > 0; })) << worker->errors();
    look(server);
}

TEST(Workers, OfAnotherSceneOrLightOrWithoutTheTokenAreTurnedAway) {
    TemporaryFolder const folder;
    std::string const token = folder.write("token", "a secret of many words\n");
    WorkedServer server("reference", {"--token-file", token});
    std::vector<std::string> const known{"--token-file", token};
    auto const other_light = WorkedServer::worker(server.address(), {"--token-file", token, "--sun-size", "3"});
    EXPECT_EQ(other_light->wait(patience), 1);
    EXPECT_NE(other_light->errors().find("other light"), std::string::npos) << other_light->errors();
    Process other_scene(FRAMELET_SERVER, {FRAMELET_SOURCE_DIR "/scenes/globe.glb", "--work-for", server.address(),
                                          "--token-file", token});
    EXPECT_EQ(other_scene.wait(patience), 1);
    EXPECT_NE(other_scene.errors().find("other light"), std::string::npos) << other_scene.errors();
    auto const stranger = WorkedServer::worker(server.address());
    EXPECT_EQ(stranger->wait(patience), 1);
    EXPECT_NE(stranger->errors().find("token"), std::string::npos) << stranger->errors();
    auto const known_one = WorkedServer::worker(server.address(), known);
    EXPECT_TRUE(server.has_workers(1)) << known_one->errors();

    WorkedServer direct("direct");
    auto const needless = WorkedServer::worker(direct.address());
    EXPECT_EQ(needless->wait(patience), 1);
    EXPECT_NE(needless->errors().find("no work"), std::string::npos) << needless->errors();
}

TEST(Workers, FindAServerThatStartsAfterThem) {
    std::string const port = free_port();
    auto const worker = WorkedServer::worker("127.0.0.1:" + port);
    EXPECT_TRUE(eventually([&] { return worker->errors().find("tried again") != std::string::npos; }));
    WorkedServer server("reference", {"--port", port});
    EXPECT_TRUE(server.has_workers(1)) << worker->errors();
    worker->signal(SIGINT);
    EXPECT_EQ(worker->wait(patience), 0);
}

} // namespace
} // namespace framelet::test
