// Runs the real server and the real windowless client as processes, over a loopback socket.
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <thread>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/files/image_io.h"
#include "server/render/framelet_renderer.h"
#include "server/render/path/path_light.h"
#include "server/render/path/path_picture.h"
#include "server/scene/motion/animation.h"
#include "server/scene/scene_import.h"
#include "tests/loopback/process.h"

namespace framelet::test {
namespace {

using namespace std::chrono_literals;

std::string const scene_file = FRAMELET_SOURCE_DIR "/scenes/vehicle_chase.glb";
constexpr auto patience = 120s; // a slow machine, sanitizers; nothing waits for it when all is well

double psnr(Picture const& a, Picture const& b) {
    EXPECT_EQ(a.width, b.width);
    EXPECT_EQ(a.height, b.height);
    double sum = 0;
    for (std::size_t i = 0; i < std::min(a.rgba.size(), b.rgba.size()); ++i) {
        double const difference = double(a.rgba[i]) - double(b.rgba[i]);
        sum += difference * difference;
    }
    double const mse = sum / (static_cast<double>(a.rgba.size()) * 3 / 4); // alpha is equal everywhere
    return mse > 0 ? 10 * std::log10(255 * 255 / mse) : 999;
}

struct StillCamera {
    Vec3 position{9, 4, 12};
    Vec3 target{0, 1, 0};
    float fov_degrees = 50;

    std::string json() const {
        return nlohmann::json{{"position", {position.x, position.y, position.z}},
                              {"target", {target.x, target.y, target.z}},
                              {"up", {0, 1, 0}},
                              {"fov_degrees", fov_degrees}}
            .dump();
    }
    Camera camera() const { return look_at(position, target, {0, 1, 0}, fov_degrees * 3.14159265f / 180); }
};

/// The picture that the server itself would draw of the scene at this time, with neither tiles nor wire, 64 samples a
/// pixel.
Picture direct_render(Camera const& camera, Viewport viewport, SceneTime time) {
    Scene const scene = import_scene(scene_file);
    auto const clips = default_clips(scene);
    RenderScene render_scene(scene, std::nullopt);
    render_scene.set_display(1);
    render_scene.set_pose(evaluate_pose(scene, clips, time));
    return render_picture(render_scene, camera, viewport, 1, 8);
}

std::vector<std::filesystem::path> frames_in(std::filesystem::path const& folder) {
    std::set<std::filesystem::path> frames;
    for (auto const& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() == ".png") {
            frames.insert(entry.path());
        }
    }
    return {frames.begin(), frames.end()};
}

/// A client that ends once its picture is complete, and the last picture it saw.
class ConvergingClient {
public:
    ConvergingClient(std::string const& address, std::string const& camera_json, std::string const& size,
                     std::vector<std::string> more = {})
        : process_(FRAMELET_CLIENT, arguments(address, camera_json, size, std::move(more))) {}

    Picture finish() {
        EXPECT_EQ(process_.wait(patience), 0) << process_.errors();
        auto const frames = frames_in(folder_.path());
        EXPECT_FALSE(frames.empty());
        return frames.empty() ? Picture() : read_picture(frames.back());
    }
    Process& process() { return process_; }

private:
    std::vector<std::string> arguments(std::string const& address, std::string const& camera_json,
                                       std::string const& size, std::vector<std::string> more) {
        std::vector<std::string> all{address,
                                     "--size",
                                     size,
                                     "--camera",
                                     folder_.write("camera.json", camera_json),
                                     "--until-converged",
                                     "--duration",
                                     "100",
                                     "--rate",
                                     "10",
                                     "--output",
                                     (folder_.path() / "%05d.png").string(),
                                     "--json"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }

    TemporaryFolder folder_;
    Process process_;
};

/// A client that goes on until it is told to stop.
class StreamingClient {
public:
    StreamingClient(std::string const& address, std::string const& size)
        : process_(FRAMELET_CLIENT, {address, "--size", size, "--duration", "100", "--no-reconnect", "--output",
                                     (folder_.path() / "%05d.png").string()}) {}

    /// Returns once it writes pictures, so its session is open.
    void wait_until_streaming() {
        auto const deadline = std::chrono::steady_clock::now() + patience;
        while (frames_in(folder_.path()).empty() && process_.running() && std::chrono::steady_clock::now() < deadline) {
            std::this_thread::sleep_for(20ms);
        }
        EXPECT_TRUE(process_.running()) << process_.errors();
    }
    Process& process() { return process_; }

private:
    TemporaryFolder folder_;
    Process process_;
};

TEST(Loopback, ConvergedPictureIsTheDirectRender) {
    ServerProcess server(scene_file, {"--paused", "--exposure", "0"});
    for (auto const& [size, viewport] : {std::pair{"320x180", Viewport{320, 180}}, {"131x97", Viewport{131, 97}}}) {
        StillCamera const view;
        ConvergingClient client(server.address(), view.json(), size);
        Picture const seen = client.finish();
        EXPECT_GE(psnr(seen, direct_render(view.camera(), viewport, 0)), 45) << size;
        auto const statistics = nlohmann::json::parse(client.process().output());
        EXPECT_TRUE(statistics.at("converged").get<bool>());
    }
}

/// A viewer that has just come, and one that has flown there, with others and without moving what it holds.
TEST(Loopback, LightByPathsIsTheSameForAllAtRest) {
    constexpr Viewport viewport{24, 16};
    ServerProcess server(scene_file, {"--paused", "--exposure", "0", "--light", "reference"});
    StillCamera const view;
    std::string const path = R"({"keys":[{"time":0,"position":[6,4,12],"target":[0,1,0],"fov_degrees":50},
        {"time":1,"position":[9,4,12],"target":[0,1,0],"fov_degrees":50}]})";
    ConvergingClient flying(server.address(), path, "24x16", {"--rate", "30"});
    ConvergingClient unmoving(server.address(), path, "24x16", {"--no-reprojection"});
    Picture const seen = flying.finish();
    EXPECT_EQ(unmoving.finish(), seen);
    ConvergingClient fresh(server.address(), view.json(), "24x16");
    EXPECT_EQ(fresh.finish(), seen);

    Scene const scene = import_scene(scene_file);
    ScenePose const pose = evaluate_pose(scene, default_clips(scene), 0);
    RenderScene render_scene(scene, std::nullopt);
    render_scene.set_display(1);
    render_scene.set_pose(pose);
    PathOptions options;
    options.paths = 1024;
    options.sizes = lamp_sizes({}, scene_bounds(scene, pose));
    Picture const same = to_display(render_paths(render_scene, view.camera(), viewport, options), 1);
    EXPECT_GE(psnr(seen, same), 45) << "the same paths, but where fewer are enough";
}

TEST(Loopback, CameraMovesArrive) {
    ServerProcess server(scene_file, {"--paused", "--exposure", "0"});
    StillCamera last;
    last.position = {-6, 3, -10};
    std::string const path = R"({"keys":[{"time":0,"position":[9,4,12],"target":[0,1,0],"fov_degrees":50},
        {"time":1,"position":[-6,3,-10],"target":[0,1,0],"fov_degrees":50}]})";
    ConvergingClient client(server.address(), path, "160x90", {"--rate", "30"});
    EXPECT_GE(psnr(client.finish(), direct_render(last.camera(), {160, 90}, 0)), 45);
}

TEST(Loopback, AnimationPlaysPausesAndSeeks) {
    ServerProcess server(scene_file, {"--paused", "--exposure", "0"});
    StillCamera const view;
    ConvergingClient at_start(server.address(), view.json(), "160x90");
    Picture const first = at_start.finish();

    TemporaryFolder folder;
    Process playing(FRAMELET_CLIENT,
                    {server.address(), "--size", "160x90", "--duration", "2", "--rate", "10", "--play", "--camera",
                     folder.write("camera.json", view.json()), "--output", (folder.path() / "%04d.png").string()});
    EXPECT_EQ(playing.wait(patience), 0) << playing.errors();
    auto const frames = frames_in(folder.path());
    ASSERT_GE(frames.size(), 10u);
    int changes = 0;
    for (std::size_t i = 5; i < frames.size(); ++i) {
        changes += read_picture(frames[i]) != read_picture(frames[i - 1]);
    }
    EXPECT_GE(changes, 5) << "a playing scene changes from frame to frame";

    ConvergingClient sought(server.address(), view.json(), "160x90", {"--pause", "--seek", "1.5"});
    Picture const later = sought.finish();
    EXPECT_GE(psnr(later, direct_render(view.camera(), {160, 90}, 1.5)), 45);
    EXPECT_LT(psnr(later, first), 45) << "the scene has moved on";
}

TEST(Loopback, TwoClientsAtOnceSeeTheirOwnViews) {
    ServerProcess server(scene_file, {"--paused", "--exposure", "0"});
    StillCamera left, right;
    left.position = {-9, 4, 8};
    ConvergingClient one(server.address(), left.json(), "200x120");
    ConvergingClient two(server.address(), right.json(), "160x160");
    EXPECT_GE(psnr(one.finish(), direct_render(left.camera(), {200, 120}, 0)), 45);
    EXPECT_GE(psnr(two.finish(), direct_render(right.camera(), {160, 160}, 0)), 45);
}

TEST(Loopback, ServerGoesOnWhenClientsVanish) {
    ServerProcess server(scene_file, {"--exposure", "0"});
    for (int how : {SIGKILL, SIGSTOP, SIGTERM}) {
        StreamingClient client(server.address(), "1280x720");
        client.wait_until_streaming();
        client.process().signal(how);
        std::this_thread::sleep_for(300ms); // stopped or gone, amid the stream
        client.process().signal(SIGKILL);
    }
    ASSERT_TRUE(server.process().running());
    StillCamera const view;
    ConvergingClient client(server.address(), view.json(), "64x64", {"--pause", "--seek", "0"});
    EXPECT_GE(psnr(client.finish(), direct_render(view.camera(), {64, 64}, 0)), 45);
    server.process().signal(SIGINT);
    EXPECT_EQ(server.process().wait(30s), 0) << server.process().errors();
}

TEST(Loopback, ClientsComeBackToAServerThatIsStartedAnew) {
    TemporaryFolder folder;
    std::string address, port = "0";
    std::optional<Process> client;
    for (std::string const& scene : {scene_file, scene_file, std::string(FRAMELET_SOURCE_DIR "/scenes/globe.glb")}) {
        bool const is_first = !client;
        ServerProcess server =
            ServerProcess::of_program(FRAMELET_SERVER, {scene, "--port", port, "--paused", "--exposure", "0"});
        address = server.address();
        port = address.substr(address.rfind(':') + 1);
        if (is_first) {
            client.emplace(FRAMELET_CLIENT,
                           std::vector<std::string>{address, "--size", "64x64", "--duration", "100", "--json",
                                                    "--frames", (folder.path() / "frames").string()});
        }
        auto const complete_since = [&](std::size_t before) {
            std::ifstream lines(folder.path() / "frames");
            std::string const text{std::istreambuf_iterator<char>(lines), {}};
            return text.find("\"complete\":true", before) != std::string::npos ? text.size() : 0;
        };
        std::size_t const before = is_first ? 0 : std::filesystem::file_size(folder.path() / "frames");
        auto const deadline = std::chrono::steady_clock::now() + patience;
        while (complete_since(before) == 0 && client->running() && std::chrono::steady_clock::now() < deadline) {
            std::this_thread::sleep_for(50ms);
        }
        EXPECT_GT(complete_since(before), 0u) << scene << client->errors();
        if (scene.ends_with("globe.glb")) {
            client->signal(SIGTERM);
            EXPECT_EQ(client->wait(30s), 0) << client->errors();
        } else {
            server.process().signal(is_first ? SIGKILL : SIGTERM);
            server.process().wait(30s);
            std::this_thread::sleep_for(500ms); // the client has noticed
        }
    }
    auto const statistics = nlohmann::json::parse(client->output());
    EXPECT_EQ(statistics.at("reconnections"), 2);
    EXPECT_EQ(statistics.at("scene"), "globe") << client->errors();
}

TEST(Loopback, ClientSaysAtTheEndThatTheServerIsGone) {
    auto server = std::make_unique<ServerProcess>(scene_file);
    Process client(FRAMELET_CLIENT, {server->address(), "--size", "64x64", "--duration", "4"});
    std::this_thread::sleep_for(2s);
    server.reset();
    EXPECT_EQ(client.wait(60s), 1);
    EXPECT_NE(client.errors().find("trying to connect again"), std::string::npos) << client.errors();
}

TEST(Loopback, ClientSaysWhenTheServerVanishes) {
    for (int how : {SIGKILL, SIGTERM, SIGSTOP}) {
        ServerProcess server(scene_file, {});
        StreamingClient client(server.address(), "320x180");
        client.wait_until_streaming();
        server.process().signal(how);
        EXPECT_EQ(client.process().wait(60s), 1);
        std::string const errors = client.process().errors();
        EXPECT_NE(errors.find("server"), std::string::npos) << errors;
        EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << errors;
    }
}

TEST(Loopback, NobodyThere) {
    Process client(FRAMELET_CLIENT, {"127.0.0.1:1", "--duration", "5"});
    EXPECT_EQ(client.wait(30s), 1);
    EXPECT_NE(client.errors().find("127.0.0.1:1"), std::string::npos) << client.errors();
}

TEST(Loopback, GarbageDoesNotHarmTheServer) {
    namespace asio = boost::asio;
    ServerProcess server(scene_file, {"--paused", "--exposure", "0"});
    std::string const port = server.address().substr(server.address().rfind(':') + 1);
    std::string const garbage[] = {std::string(1000, '\xff'), "GET / HTTP/1.1\r\n\r\n", std::string(4, '\0'),
                                   std::string("\x05\0\0\0abc", 7),
                                   std::string("\x10\0\0\0", 4) + std::string(16, 'x')};
    for (auto const& bytes : garbage) {
        asio::io_context io;
        asio::ip::tcp::socket socket(io);
        asio::connect(socket, asio::ip::tcp::resolver(io).resolve("127.0.0.1", port));
        boost::system::error_code ignored;
        asio::write(socket, asio::buffer(bytes), ignored);
        socket.shutdown(asio::socket_base::shutdown_send, ignored);
    }
    StillCamera const view;
    ConvergingClient client(server.address(), view.json(), "64x64");
    EXPECT_GE(psnr(client.finish(), direct_render(view.camera(), {64, 64}, 0)), 45);
}

TEST(Loopback, TokenIsAsked) {
    TemporaryFolder folder;
    std::string const right = folder.write("right", "open sesame, please\n");
    std::string const wrong = folder.write("wrong", "open barley, please\n");
    ServerProcess server(scene_file, {"--token-file", right, "--paused"});
    auto const connect = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {server.address(), "--size", "64x64", "--duration", "60", "--until-converged"});
        auto client = std::make_unique<Process>(FRAMELET_CLIENT, more);
        int const code = client->wait(patience);
        return std::pair{code, client->errors()};
    };
    EXPECT_EQ(connect({"--token-file", right}).first, 0);
    for (auto const& more : {std::vector<std::string>{}, {"--token-file", wrong}}) {
        auto const [code, errors] = connect(more);
        EXPECT_EQ(code, 1);
        EXPECT_NE(errors.find("token"), std::string::npos) << errors;
    }
}

TEST(Loopback, TlsProtectsAndIsChecked) {
    TemporaryFolder folder;
    auto const [certificate, key] = make_certificate(folder, "own");
    auto const [other_certificate, other_key] = make_certificate(folder, "other");
    ServerProcess server(scene_file, {"--tls-cert", certificate, "--tls-key", key, "--paused"});
    auto const connect = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {server.address(), "--size", "64x64", "--duration", "60", "--until-converged"});
        Process client(FRAMELET_CLIENT, more);
        return client.wait(patience);
    };
    EXPECT_EQ(connect({"--tls", "--tls-ca", certificate}), 0);
    EXPECT_EQ(connect({"--tls", "--tls-ca", other_certificate}), 1) << "nobody vouches for the certificate";
    EXPECT_EQ(connect({}), 1) << "plain text is not served";
    EXPECT_EQ(server.process().errors().find("--tls-key"), std::string::npos) << server.process().errors();
    std::filesystem::permissions(key, std::filesystem::perms(0644));
    ServerProcess open(scene_file, {"--tls-cert", certificate, "--tls-key", key, "--paused"});
    EXPECT_NE(open.process().errors().find("every user of this machine can read"), std::string::npos)
        << open.process().errors();
}

TEST(Loopback, ACertificateThatNobodyVouchesForIsAskedAboutAndTrustedUntilItChanges) {
    TemporaryFolder folder;
    ASSERT_EQ(::setenv("XDG_STATE_HOME", folder.path().c_str(), 1), 0); // what is remembered goes with the test
    auto const [certificate, key] = make_certificate(folder, "first");
    auto const [other_certificate, other_key] = make_certificate(folder, "other");
    std::string const token = folder.write("token", "0123456789abcdef0123456789abcdef\n");
    std::string address;
    auto const options = [&] {
        return std::vector<std::string>{address,      "--tls", "--token-file",     token, "--size", "64x64",
                                        "--duration", "60",    "--until-converged"};
    };
    auto const connect = [&] {
        Process client(FRAMELET_CLIENT, options());
        int const code = client.wait(patience);
        return std::pair{code, client.errors()};
    };
    auto const answer = [&](std::string const& word) { // at a terminal
        std::string command = FRAMELET_CLIENT;
        for (std::string const& option : options()) {
            command += " '" + option + "'";
        }
        Process client("/bin/sh", {"-c", "echo " + word + " | script -qec \"$0\" /dev/null", command});
        int const code = client.wait(patience);
        return std::pair{code, client.output()};
    };
    {
        ServerProcess server(scene_file,
                             {"--tls-cert", certificate, "--tls-key", key, "--token-file", token, "--paused"});
        address = server.address();
        std::string const mark = "certificate SHA-256 ";
        std::string printed;
        ASSERT_TRUE(eventually([&] { // it says its address first
            printed = server.process().output();
            return printed.ends_with('\n') && printed.find(mark) != std::string::npos;
        })) << printed;
        std::size_t const start = printed.find(mark);
        std::string const fingerprint = printed.substr(start + mark.size(), 95);
        auto const [code, refusal] = connect();
        EXPECT_EQ(code, 1) << "nobody can be asked";
        EXPECT_NE(refusal.find(fingerprint), std::string::npos) << refusal;
        EXPECT_EQ(std::count(refusal.begin(), refusal.end(), '\n'), 1) << refusal;
        auto const [denied, question] = answer("no");
        EXPECT_EQ(denied, 1) << question;
        EXPECT_NE(question.find(fingerprint), std::string::npos) << question;
        EXPECT_EQ(connect().first, 1) << "it is not trusted yet";
        EXPECT_EQ(server.process().errors().find("viewer 1 connects"), std::string::npos) << "nor has a token gone";
        auto const [granted, told] = answer("yes");
        EXPECT_EQ(granted, 0) << told;
        EXPECT_EQ(connect(), std::pair(0, std::string())) << "it is known by now";
    }
    ServerProcess const impostor = ServerProcess::of_program(
        FRAMELET_SERVER, {scene_file, "--port", address.substr(address.rfind(':') + 1), "--tls-cert", other_certificate,
                          "--tls-key", other_key, "--token-file", token, "--paused"});
    auto const [code, errors] = connect();
    EXPECT_EQ(code, 1);
    EXPECT_NE(errors.find("known_servers"), std::string::npos) << errors;
    EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << errors;
    ::unsetenv("XDG_STATE_HOME");
}

TEST(Loopback, ViewersBeyondTheLimitAreToldSo) {
    ServerProcess server(scene_file, {"--max-sessions", "1"});
    StreamingClient first(server.address(), "64x64");
    first.wait_until_streaming();
    Process second(FRAMELET_CLIENT, {server.address(), "--size", "64x64", "--duration", "60"});
    EXPECT_EQ(second.wait(30s), 1);
    EXPECT_NE(second.errors().find("--max-sessions"), std::string::npos) << second.errors();
    EXPECT_TRUE(first.process().running());
}

struct Usage {
    std::string program;
    std::vector<std::string> arguments;
    int exit_code;
    std::string says;
};

TEST(Loopback, LoadingIsOneLineOfALog) {
    ServerProcess server(scene_file);
    std::string const log = server.process().errors();
    EXPECT_EQ(log.find('\r'), std::string::npos) << log;
    EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 1) << log;
    EXPECT_NE(log.find(" triangles, "), std::string::npos) << log;
    EXPECT_NE(log.find(" stops; loaded in "), std::string::npos) << log;
}

TEST(Loopback, BadInputGetsOneLineAndTheRightExitCode) {
    TemporaryFolder folder, bare;
    std::string const broken = folder.write("broken.gltf", "{ \"asset\": ");
    std::string const text = folder.write("notes.txt", "not a scene");
    std::string const empty =
        folder.write("empty.gltf", R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{}]})");
    Usage const cases[] = {
        {FRAMELET_SERVER, {}, 2, "SCENE"},
        {FRAMELET_SERVER, {scene_file, "--prot", "1"}, 2, "--prot"},
        {FRAMELET_SERVER, {scene_file, "--port", "70000"}, 2, "from 0 to 65535"},
        {FRAMELET_SERVER, {scene_file, "--bind", "0.0.0.0", "--port", "0"}, 2, "--token-file"},
        {FRAMELET_SERVER, {"/nonexistent/scene.glb"}, 1, "/nonexistent/scene.glb"},
        {FRAMELET_SERVER, {broken}, 1, "broken.gltf"},
        {FRAMELET_SERVER, {text}, 1, "notes.txt"},
        {FRAMELET_SERVER, {bare.path().string()}, 1, "': name a scene file, or a folder that"},
        {FRAMELET_SERVER, {scene_file, bare.path().string()}, 1, "lists the scenes in it"},
        {FRAMELET_SERVER, {scene_file, broken}, 1, "broken.gltf"},
        {FRAMELET_SERVER, {empty, empty}, 1, "nothing to see in these scenes"},
        {FRAMELET_SERVER, {"--clip", "no such", scene_file, scene_file}, 1, "no such"},
        {FRAMELET_SERVER, {scene_file, "--environment", text}, 1, "notes.txt"},
        {FRAMELET_SERVER, {scene_file, "--clip", "no such"}, 1, "no such"},
        {FRAMELET_SERVER, {scene_file, "--scene", "no such"}, 1, "there is no scene 'no such' in it; it has 0"},
        {FRAMELET_SERVER, {scene_file, "--scene", "99"}, 1, "there is no scene '99'"},
        {FRAMELET_SERVER, {scene_file, scene_file, "--scene", "0"}, 2, "--scene chooses a scene of one file"},
        {FRAMELET_SERVER, {scene_file, "--up", "w"}, 2, "x, y or z, not 'w'"},
        {FRAMELET_SERVER, {scene_file, "--light", "moon"}, 2, "light is direct, full or reference, not 'moon'"},
        {FRAMELET_SERVER, {scene_file, "--sun-size", "91"}, 2, "from 0 to 90"},
        {FRAMELET_SERVER, {scene_file, "--lamp-size", "nan"}, 2, "--lamp-size"},
        {FRAMELET_SERVER, {scene_file, "--unit", "parsec"}, 2, "mm, cm, m, km, in or ft, not 'parsec'"},
        {FRAMELET_SERVER, {empty}, 1, "empty.gltf': it has no triangles"},
        {FRAMELET_SERVER, {scene_file, "--exposure", "nan"}, 2, "--exposure"},
        {FRAMELET_SERVER, {scene_file, "--exposure", "inf"}, 2, "--exposure"},
        {FRAMELET_SERVER, {scene_file, "--bias", "nan"}, 2, "--bias"},
        {FRAMELET_SERVER, {scene_file, "--scene-memory", "1"}, 1, "--scene-memory"},
        {FRAMELET_SERVER, {scene_file, "--scene-memory", "0"}, 2, "--scene-memory"},
        {FRAMELET_CLIENT, {"127.0.0.1:7070", "--exposure", "nan"}, 2, "--exposure"},
        {FRAMELET_CLIENT, {"127.0.0.1:7070", "--exposure", "-inf"}, 2, "--exposure"},
        {FRAMELET_CLIENT, {"127.0.0.1:7070", "--seek", "nan"}, 2, "--seek"},
        {FRAMELET_CLIENT, {"127.0.0.1:7070", "--duration", "nan"}, 2, "--duration"},
        {FRAMELET_CLIENT, {"127.0.0.1:7070", "--rate", "nan"}, 2, "--rate"},
        {FRAMELET_CLIENT, {"127.0.0.1:7070", "--output-times", "nan"}, 2, "--output-times"},
        {FRAMELET_CLIENT, {"127.0.0.1:7070", "--output-times", "1"}, 2, "numbered"},
        {FRAMELET_CLIENT, {"127.0.0.1:7070", "--output", "one.png", "--output-times", "1"}, 2, "numbered"},
        {FRAMELET_CLIENT, {"127.0.0.1:7070", "--smooth=nan"}, 2, "--smooth"},
        {FRAMELET_CLIENT, {}, 2, "HOST[:PORT]"},
        {FRAMELET_CLIENT, {"127.0.0.1:7070", "--smooth", "5000"}, 2, "from 0 to 1000"},
        {FRAMELET_CLIENT, {"127.0.0.1:7070", "--overlay", "foo"}, 2, "arrivals or holes"},
        {FRAMELET_CLIENT, {"127.0.0.1:7070", "--overlay=foo"}, 2, "arrivals or holes"},
        {FRAMELET_CLIENT, {"127.0.0.1:7070", "--token-file", "/nonexistent/token"}, 1, "/nonexistent/token"},
        {FRAMELET_SERVER, {scene_file, "--port", "0", "--token-file", "/nonexistent/token"}, 1, "/nonexistent/token"},
        {FRAMELET_CLIENT, {"nonsense:"}, 2, "nonsense"},
        {FRAMELET_CLIENT, {"127.0.0.1:7070", "--size", "0x5"}, 2, "size"},
        {FRAMELET_CLIENT, {"127.0.0.1:7070", "--camera", broken}, 1, "broken.gltf"},
    };
    for (Usage const& usage : cases) {
        Process process(usage.program, usage.arguments);
        EXPECT_EQ(process.wait(60s), usage.exit_code) << usage.says << process.errors();
        std::string errors = process.errors();
        std::size_t const last = errors.rfind("framelet-");
        ASSERT_NE(last, std::string::npos) << errors;
        EXPECT_NE(errors.find(usage.says, last), std::string::npos) << errors;
        EXPECT_EQ(std::count(errors.begin() + static_cast<std::ptrdiff_t>(last), errors.end(), '\n'), 1) << errors;
    }
    // These options are no part of the scene, and are found to be wrong before the scene is looked at.
    ServerProcess const other(scene_file);
    std::string const port = other.address().substr(other.address().rfind(':') + 1);
    std::vector<std::vector<std::string>> const early{{"--port", port},
                                                      {"--port", "0", "--environment", text},
                                                      {"--port", "0", "--tls-cert", text, "--tls-key", text}};
    for (std::vector<std::string> arguments : early) {
        arguments.insert(arguments.begin(), "/nonexistent/scene.glb");
        Process process(FRAMELET_SERVER, arguments);
        EXPECT_EQ(process.wait(60s), 1);
        EXPECT_EQ(process.errors().find("scene.glb"), std::string::npos) << process.errors();
    }
    for (auto const* program : {FRAMELET_SERVER, FRAMELET_CLIENT}) {
        for (auto const* option : {"--help", "--version"}) {
            Process process(program, {option});
            EXPECT_EQ(process.wait(30s), 0);
            EXPECT_FALSE(process.output().empty());
        }
    }
}

} // namespace
} // namespace framelet::test
