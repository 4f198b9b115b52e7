// Runs the real server while its scene changes: by itself with --watch, on SIGHUP without; viewers stay, and what does
// not load costs nobody anything.
#include <atomic>
#include <csignal>
#include <fstream>
#include <memory>
#include <sstream>
#include <thread>

#include <gtest/gtest.h>
#include <pty.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "client/core/client_core.h"
#include "tests/loopback/metrics_page.h"
#include "tests/loopback/process.h"

namespace framelet::test {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

fs::path const scenes = FRAMELET_SOURCE_DIR "/scenes";
constexpr auto patience = 120s;

std::size_t times(std::string const& text, std::string const& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
        ++count;
    }
    return count;
}

/// A viewer that looks until it is told otherwise.
struct Viewer {
    explicit Viewer(std::string const& address) {
        ConnectionOptions options;
        options.server = parse_server_address(address);
        options.reconnect = true;
        core = std::make_unique<ClientCore>(options);
        core->set_view(look_at({3, 2, 5}, {0, 1, 0}, {0, 1, 0}, 0.9f), {160, 90});
    }

    bool sees(std::function<bool()> const& wanted) {
        bool const seen = eventually([&] {
            core->update_picture(picture, changed);
            return core->end_reason() || wanted();
        });
        core->update_picture(picture, changed); // what came between the picture and the answer
        return seen && !core->end_reason();
    }
    bool comes_to_rest() {
        return sees([this] { return core->is_complete() && !core->interruption(); });
    }
    bool comes_back(std::uint64_t how_often) {
        return sees([&] { return core->statistics().reconnections >= how_often && !core->interruption(); });
    }

    std::unique_ptr<ClientCore> core;
    Picture picture;
    std::vector<PixelRect> changed;
};

struct Reloading : testing::Test {
    TemporaryFolder const folder;
    std::string const file = (folder.path() / "scene.glb").string();

    Reloading() { put("windmill.glb"); }
    /// Saves the scene as careful programs do: the whole file at once.
    void put(char const* name) const {
        fs::copy_file(scenes / name, folder.path() / "new", fs::copy_options::overwrite_existing);
        fs::rename(folder.path() / "new", file);
    }
};

TEST_F(Reloading, AChangedFileIsShownToThoseWhoAreThere) {
    ServerProcess server(file, {"--watch", "--paused", "--exposure", "0", "--insecure"});
    Viewer viewer(server.address());
    ASSERT_TRUE(viewer.comes_to_rest());
    Picture const before = viewer.picture;
    std::uint64_t const scene = viewer.core->scene_number();
    put("dim.glb");
    ASSERT_TRUE(viewer.comes_back(1)) << server.process().errors();
    ASSERT_TRUE(viewer.comes_to_rest());
    EXPECT_GT(viewer.core->scene_number(), scene);
    EXPECT_NE(viewer.picture, before);
    put("windmill.glb");
    ASSERT_TRUE(viewer.comes_back(2)) << server.process().errors();
    ASSERT_TRUE(viewer.comes_to_rest());
    EXPECT_EQ(viewer.picture, before) << "seen by the same camera";
    server.process().signal(SIGTERM);
    EXPECT_EQ(server.process().wait(30s), 0);
}

TEST_F(Reloading, AHalfWrittenFileLeavesTheSceneAsItWas) {
    ServerProcess server(file, {"--watch", "--paused", "--insecure"});
    Viewer viewer(server.address());
    ASSERT_TRUE(viewer.comes_to_rest());
    fs::resize_file(file, fs::file_size(file) / 2);
    ASSERT_TRUE(eventually([&] { return times(server.process().errors(), "truncated") > 0; }));
    std::this_thread::sleep_for(1s);
    EXPECT_EQ(times(server.process().errors(), "truncated"), 1u) << server.process().errors();
    EXPECT_EQ(viewer.core->statistics().reconnections, 0u);
    Viewer other(server.address());
    EXPECT_TRUE(other.comes_to_rest());
    put("dim.glb");
    EXPECT_TRUE(viewer.comes_back(1)) << server.process().errors();
    EXPECT_TRUE(viewer.comes_to_rest());
}

TEST_F(Reloading, FilesBesideTheSceneCount) {
    std::string const text = folder.write("triangle.gltf", R"({"asset":{"version":"2.0"},"scene":0,
        "scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "buffers":[{"uri":"triangle.bin","byteLength":36}],"bufferViews":[{"buffer":0,"byteLength":36}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[9,9,9]}]})");
    auto const write_corners = [&](float size) {
        float const corners[9] = {0, 0, 0, size, 0, 0, 0, size, 0};
        std::ofstream(folder.path() / "triangle.bin", std::ios::binary)
            .write(reinterpret_cast<char const*>(corners), sizeof corners);
    };
    write_corners(1);
    ServerProcess server(text, {"--watch", "--paused", "--insecure"});
    Viewer viewer(server.address());
    ASSERT_TRUE(viewer.comes_to_rest());
    EXPECT_EQ(viewer.core->welcome().scene_bounds.upper.x, 1);
    folder.write("notes.txt", "of no account");
    write_corners(2);
    ASSERT_TRUE(viewer.comes_back(1)) << server.process().errors();
    EXPECT_EQ(viewer.core->welcome().scene_bounds.upper.x, 2);
    EXPECT_EQ(times(server.process().errors(), "loading the scene again"), 1u);
}

TEST_F(Reloading, EachOfSeveralFilesCounts) {
    fs::path const other = folder.path() / "other.glb";
    fs::copy_file(scenes / "globe.glb", other);
    ServerProcess server(file, {other, "--watch", "--paused", "--exposure", "0", "--insecure"});
    Viewer viewer(server.address());
    ASSERT_TRUE(viewer.comes_to_rest());
    EXPECT_EQ(viewer.core->welcome().scene_name, "scene + other");
    Picture const before = viewer.picture;
    std::uint64_t const scene = viewer.core->scene_number();
    fs::copy_file(scenes / "dim.glb", folder.path() / "new");
    fs::rename(folder.path() / "new", other);
    ASSERT_TRUE(viewer.comes_back(1)) << server.process().errors();
    ASSERT_TRUE(viewer.comes_to_rest());
    EXPECT_GT(viewer.core->scene_number(), scene);
    EXPECT_NE(viewer.picture, before);
    put("foliage.glb");
    EXPECT_TRUE(viewer.comes_back(2)) << server.process().errors();
}

TEST_F(Reloading, ASignalDoesItToo) {
    ServerProcess server(file, {"--paused", "--insecure"});
    Viewer viewer(server.address());
    ASSERT_TRUE(viewer.comes_to_rest());
    std::uint64_t const scene = viewer.core->scene_number();
    server.process().signal(SIGHUP);
    ASSERT_TRUE(viewer.comes_back(1)) << server.process().errors();
    ASSERT_TRUE(viewer.comes_to_rest());
    EXPECT_EQ(viewer.core->scene_number(), scene) << "nothing has changed: what is held is shown on";
    EXPECT_TRUE(server.process().running());
}

TEST_F(Reloading, WhileEverythingMovesItDoesNoHarm) {
    ServerProcess server(file, {"--insecure"});
    Viewer viewer(server.address());
    Viewer other(server.address());
    for (std::uint64_t i = 1; i <= 4; ++i) {
        ASSERT_TRUE(viewer.sees([&, batches = viewer.core->statistics().batches] {
            return viewer.core->statistics().batches > batches + 5;
        }));
        server.process().signal(SIGHUP);
        ASSERT_TRUE(viewer.comes_back(i)) << server.process().errors();
        ASSERT_TRUE(other.comes_back(i)) << server.process().errors();
    }
    EXPECT_GT(viewer.core->status().clock.time, 0) << "the clock goes on";
}

/// A triangle, as a .gltf file, and so many cameras.
std::string triangle_and_cameras(int cameras) {
    std::string nodes = R"({"mesh":0})", roots = "0";
    for (int i = 1; i <= cameras; ++i) {
        nodes += R"(,{"camera":0})";
        roots += "," + std::to_string(i);
    }
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[)" + roots + R"(]}],"nodes":[)" + nodes +
           R"(],"cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":1}}],)"
           R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
           R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],)"
           R"("bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":)"
           R"("data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
}

TEST_F(Reloading, WhoIsServedGoesOnWhileASceneWithVeryManyCamerasIsRead) {
    std::string const text = folder.write("scene.gltf", triangle_and_cameras(1));
    ServerProcess server(text, {"--paused", "--insecure", "--metrics", "0"});
    std::string const address = metrics_address(server);
    Viewer viewer(server.address());
    ASSERT_TRUE(viewer.comes_to_rest());
    folder.write("scene.gltf", triangle_and_cameras(120'000));
    server.process().signal(SIGHUP);
    std::atomic<int> well = 0, unwell = 0;
    std::jthread health([&](std::stop_token const& stop) {
        while (!stop.stop_requested()) {
            ++(ask(address, "/health").result() == http::status::ok ? well : unwell);
            std::this_thread::sleep_for(5ms);
        }
    });
    int looks = 0; // that were answered
    for (std::uint64_t batches = 0; viewer.core->statistics().reconnections == 0; ++looks) {
        batches = viewer.core->statistics().batches;
        float const aside = 0.01f * static_cast<float>(1 + looks % 100);
        viewer.core->set_view(look_at({3 + aside, 2, 5}, {0, 1, 0}, {0, 1, 0}, 0.9f), {160, 90});
        ASSERT_TRUE(viewer.sees([&] {
            return viewer.core->statistics().batches > batches || viewer.core->statistics().reconnections > 0;
        })) << looks;
    }
    health.request_stop();
    health.join();
    EXPECT_GT(well, 3);
    EXPECT_EQ(unwell, 0);
    EXPECT_GT(looks, 3) << "otherwise this tests nothing: " << server.process().errors();
    ASSERT_TRUE(viewer.comes_back(1)) << server.process().errors();
    EXPECT_GT(viewer.core->welcome().cameras.size(), 1u);
    EXPECT_TRUE(viewer.comes_to_rest());
}

/// Address space that a process may have, bytes; RLIM_INFINITY: as much as it likes.
rlim_t limit_of(pid_t process) {
    rlimit limit{};
    EXPECT_EQ(::prlimit(process, RLIMIT_AS, nullptr, &limit), 0);
    return limit.rlim_cur;
}

/// A square of so many squares, as an .obj file.
std::string squares(int side) {
    std::ostringstream text;
    for (int y = 0; y <= side; ++y) {
        for (int x = 0; x <= side; ++x) {
            text << "v " << x << ' ' << y << " 0\n";
        }
    }
    for (int y = 0; y < side; ++y) {
        for (int x = 1; x <= side; ++x) {
            int const corner = y * (side + 1) + x;
            text << "f " << corner << ' ' << corner + 1 << ' ' << corner + side + 2 << ' ' << corner + side + 1 << '\n';
        }
    }
    return text.str();
}

TEST_F(Reloading, WhoIsServedHasMemoryWhileAnotherSceneIsRead) {
    std::string const text = folder.write("scene.obj", squares(2));
    ServerProcess server(text, {"--paused", "--insecure"});
    rlim_t const before = limit_of(server.process().pid());
    Viewer viewer(server.address());
    ASSERT_TRUE(viewer.comes_to_rest());
    folder.write("scene.obj", squares(300));
    server.process().signal(SIGHUP);
    std::atomic<bool> is_there = false;
    rlim_t least = before;
    std::thread watcher([&] {
        while (!is_there) {
            least = std::min(least, limit_of(server.process().pid()));
            std::this_thread::sleep_for(1ms);
        }
    });
    EXPECT_TRUE(viewer.comes_back(1)) << server.process().errors();
    is_there = true;
    watcher.join();
    EXPECT_EQ(least, before);
    EXPECT_EQ(viewer.core->welcome().scene_bounds.upper.x, 300);
}

TEST_F(Reloading, AFileThatTakesTooMuchLeavesTheSceneAsItWas) {
#ifdef FRAMELET_SANITIZE
    GTEST_SKIP() << "the sanitizer ends a program that is refused memory";
#endif
    std::string const triangle = " 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    std::string const text = folder.write("scene.off", "OFF\n3" + triangle);
    ServerProcess server(text, {"--paused", "--insecure", "--scene-memory", "64"});
    Viewer viewer(server.address());
    ASSERT_TRUE(viewer.comes_to_rest());
    folder.write("scene.off", "OFF\n#" + std::string(5000, 'x') + "\n60000000" + triangle);
    server.process().signal(SIGHUP);
    ASSERT_TRUE(eventually([&] { return times(server.process().errors(), "as it was is served on") > 0; }));
    EXPECT_EQ(times(server.process().errors(), "'" + text + "': it takes more than 64 MB"), 1u)
        << server.process().errors();
    EXPECT_EQ(viewer.core->statistics().reconnections, 0u);
    folder.write("scene.off", "OFF\n3" + triangle);
    server.process().signal(SIGHUP);
    EXPECT_TRUE(viewer.comes_back(1)) << server.process().errors();
}

/// What reads a scene first may never come to an end of it; here it cannot say what it has found.
TEST(ImportProcess, EndsWithTheServerThatHasStartedIt) {
    TemporaryFolder const folder;
    std::string nodes(R"({"mesh":0})");
    for (int i = 0; i < 5000; ++i) {
        nodes += R"(,{"camera":0})";
    }
    std::string const scene =
        folder.write("cameras.gltf", R"({"asset":{"version":"2.0"},"nodes":[)" + nodes +
                                         R"(],"cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":1}}],)"
                                         R"("meshes":[{"primitives":[{"attributes":{}}]}]})");
    std::string const reader = "echo $$ > reader; exec " FRAMELET_SERVER " --info --json --news 1 " + scene;
    Process shell("/bin/sh", {"-c", "cd " + folder.path().string() + "; sh -c '" + reader +
                                        "' | sh -c 'read line; echo $$ > idle; exec sleep 1000'"});
    auto const id_in = [&](char const* name) {
        pid_t id = 0;
        return eventually([&] { return bool(std::ifstream(folder.path() / name) >> id); }) ? id : pid_t{0};
    };
    pid_t const reading = id_in("reader"), idle = id_in("idle");
    ASSERT_GT(reading, 0);
    ASSERT_GT(idle, 0);
    EXPECT_EQ(::kill(reading, 0), 0);
    shell.signal(SIGKILL);
    EXPECT_TRUE(eventually([&] { return ::kill(reading, 0) != 0; }));
    ::kill(idle, SIGKILL);
}

TEST_F(Reloading, WhereTheTerminalIsGoneTheServerEnds) {
    int terminal = -1;
    pid_t const server = ::forkpty(&terminal, nullptr, nullptr, nullptr);
    if (server == 0) {
        ::execl(FRAMELET_SERVER, FRAMELET_SERVER, file.c_str(), "--port", "0", "--paused", "--insecure", nullptr);
        ::_exit(127);
    }
    ASSERT_GT(server, 0);
    std::string told;
    char some[4096];
    std::string const before_address = "listening on ";
    while (told.find(before_address) == std::string::npos ||
           told.find_first_of("\r\n", told.find(before_address)) == std::string::npos) {
        ssize_t const bytes = ::read(terminal, some, sizeof some);
        ASSERT_GT(bytes, 0) << told;
        told.append(some, static_cast<std::size_t>(bytes));
    }
    std::size_t const at = told.find(before_address) + before_address.size();
    Viewer viewer(told.substr(at, told.find_first_of("\r\n", at) - at));
    EXPECT_TRUE(viewer.comes_to_rest());
    ::close(terminal);
    int status = -1;
    bool const ended = eventually([&] { return ::waitpid(server, &status, WNOHANG) == server; });
    if (!ended) {
        ::kill(server, SIGKILL);
    }
    EXPECT_TRUE(ended);
    EXPECT_EQ(status, 0);
}

TEST_F(Reloading, ARecordingIsOfOneScene) {
    Process both(FRAMELET_SERVER, {file, "--watch", "--record-events", (folder.path() / "events").string()});
    EXPECT_EQ(both.wait(patience), 2);
    ServerProcess server(file, {"--paused", "--insecure", "--record-events", (folder.path() / "events").string()});
    server.process().signal(SIGHUP);
    EXPECT_TRUE(eventually([&] { return times(server.process().errors(), "--record-events") > 0; }));
    EXPECT_EQ(times(server.process().errors(), "loading the scene again"), 0u);
}

} // namespace
} // namespace framelet::test
