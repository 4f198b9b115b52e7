// Tests what those who run the programs meet: what is asked of a scene without serving it, options in a file, and the
// port for those who watch over a server.
#include <algorithm>
#include <csignal>
#include <deque>
#include <fstream>
#include <regex>
#include <sstream>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <pty.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/loopback/metrics_page.h"
#include "tests/loopback/process.h"

namespace framelet::test {
namespace {

using namespace std::chrono_literals;

std::string const scene_file = FRAMELET_SOURCE_DIR "/scenes/windmill.glb";
constexpr auto patience = 120s;

bool has(std::string const& text, std::string const& part) {
    return text.find(part) != std::string::npos;
}

TEST(Operation, InfoSaysWhatIsInASceneAndServesNothing) {
    Process text(FRAMELET_SERVER, {"--info", scene_file});
    EXPECT_EQ(text.wait(patience), 0) << text.errors();
    EXPECT_TRUE(has(text.output(), "1 camera") && has(text.output(), "vane wheel")) << text.output();
    EXPECT_FALSE(has(text.output(), "listening"));
    Process json(FRAMELET_SERVER, {"--info", "--json", scene_file});
    EXPECT_EQ(json.wait(patience), 0) << json.errors();
    EXPECT_EQ(nlohmann::json::parse(json.output())["moving_bodies"].size(), 2u) << json.output();
    Process absent(FRAMELET_SERVER, {"--info", "absent.glb"});
    EXPECT_EQ(absent.wait(patience), 1);
    EXPECT_TRUE(has(absent.errors(), "absent.glb")) << absent.errors();
    Process alone(FRAMELET_SERVER, {"--json", scene_file});
    EXPECT_EQ(alone.wait(patience), 2);
    EXPECT_TRUE(has(alone.errors(), "--info")) << alone.errors();
}

TEST(Operation, WhatCannotBePrintedIsAFailure) {
    ServerProcess server(scene_file, {"--paused", "--insecure"});
    for (std::vector<std::string> const& words :
         {std::vector<std::string>{FRAMELET_SERVER, "--info", "--json", scene_file},
          {FRAMELET_SERVER, "--info", scene_file},
          {FRAMELET_SERVER, FRAMELET_SOURCE_DIR "/scenes"},
          {FRAMELET_SERVER, "--make-token"},
          {FRAMELET_CLIENT, server.address(), "--size", "64x64", "--until-converged", "--json"}}) {
        std::vector<std::string> arguments{"-c", "exec \"$0\" \"$@\" >/dev/full"};
        arguments.insert(arguments.end(), words.begin(), words.end());
        Process program("/bin/sh", arguments);
        EXPECT_EQ(program.wait(patience), 1) << words[1];
        EXPECT_TRUE(has(program.errors(), "cannot write to standard output")) << program.errors();
    }
}

nlohmann::json info_of(std::vector<std::string> const& scenes) {
    std::vector<std::string> arguments{"--info", "--json"};
    arguments.insert(arguments.end(), scenes.begin(), scenes.end());
    Process info(FRAMELET_SERVER, arguments);
    EXPECT_EQ(info.wait(patience), 0) << info.errors();
    return nlohmann::json::parse(info.output());
}

TEST(Operation, InfoOfSeveralScenesIsOfAllThatIsInThem) {
    std::string const other = FRAMELET_SOURCE_DIR "/scenes/globe.glb";
    nlohmann::json const first = info_of({scene_file}), second = info_of({other}), both = info_of({scene_file, other});
    EXPECT_EQ(both["scene"], "windmill + globe");
    for (char const* const what : {"triangles", "nodes", "materials", "images", "image_bytes"}) {
        EXPECT_EQ(both[what], first[what].get<std::size_t>() + second[what].get<std::size_t>()) << what;
    }
    for (char const* const what : {"cameras", "lights", "clips", "moving_bodies"}) {
        EXPECT_EQ(both[what].size(), first[what].size() + second[what].size()) << what;
    }
}

TEST(Operation, AFolderIsListedWithHowToServeEachScene) {
    TemporaryFolder const folder;
    std::string const plain = folder.write("b.glb", ""), spaced = folder.write("a house.obj", "");
    folder.write("notes.txt", "");
    Process list(FRAMELET_SERVER, {folder.path().string()});
    EXPECT_EQ(list.wait(patience), 0) << list.errors();
    EXPECT_EQ(list.output(), "framelet-server '" + spaced + "'\nframelet-server " + plain + "\n");
    EXPECT_EQ(list.errors(), "");
}

/// The messages of a log of JSON, "LEVEL: MESSAGE" each. Every line has to be an object of time, level and message.
std::vector<std::string> messages_of(std::string const& log) {
    std::vector<std::string> messages;
    std::istringstream lines(log);
    for (std::string line; std::getline(lines, line);) {
        nlohmann::json const said = nlohmann::json::parse(line, nullptr, false);
        if (!said.is_object() || said.size() != 3) {
            ADD_FAILURE() << line;
            continue;
        }
        std::regex const time(R"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z)");
        EXPECT_TRUE(std::regex_match(said.value("time", ""), time)) << line;
        messages.push_back(said.value("level", "") + ": " + said.value("message", ""));
    }
    return messages;
}

TEST(Operation, ALogOfJsonIsOneObjectALine) {
    TemporaryFolder const folder;
    std::filesystem::path const file = folder.path() / "a \"red\"\\\n house.glb";
    std::filesystem::copy_file(scene_file, file);
    ServerProcess server(file, {scene_file, "--log", "json", "--paused"});
    Process client(FRAMELET_CLIENT, {server.address(), "--size", "64x64", "--until-converged"});
    EXPECT_EQ(client.wait(patience), 0) << client.errors();
    server.process().signal(SIGTERM);
    EXPECT_EQ(server.process().wait(patience), 0);
    std::vector<std::string> const messages = messages_of(server.process().errors());
    for (std::string const part : {"info: a \"red\"\\? house + windmill: ", "info: viewer 1 connects",
                                   "info: viewer 1 left", "info: ending on signal 15"}) {
        EXPECT_TRUE(std::ranges::any_of(messages, [&](auto const& m) { return m.starts_with(part); }))
            << part << server.process().errors();
    }
}

TEST(Operation, TheLastLineOfALogOfJsonSaysWhatWasWrong) {
    struct Wrong {
        std::vector<std::string> arguments;
        int exit_code;
        std::string message;
    };
    for (Wrong const& wrong :
         {Wrong{
              {"absent \"x\".glb", "--log", "json"}, 1, "cannot load scene 'absent \"x\".glb': there is no such file"},
          Wrong{{scene_file, "--log=json", "--bind", "0.0.0.0"}, 2, "--bind 0.0.0.0 can be reached"},
          Wrong{{scene_file, "--prot", "1", "--log=json"}, 2, "unknown: --prot; did you mean --port?"}}) {
        Process process(FRAMELET_SERVER, wrong.arguments);
        EXPECT_EQ(process.wait(patience), wrong.exit_code) << process.errors();
        std::vector<std::string> const messages = messages_of(process.errors());
        ASSERT_EQ(messages.size(), 1u) << process.errors();
        EXPECT_TRUE(messages[0].starts_with("error: " + wrong.message)) << messages[0];
    }
}

TEST(Operation, ATerminalIsToldHowFarLoadingIs) {
    int terminal = -1;
    pid_t const server = ::forkpty(&terminal, nullptr, nullptr, nullptr);
    if (server == 0) {
        ::execl(FRAMELET_SERVER, FRAMELET_SERVER, "--info", scene_file.c_str(), nullptr);
        ::_exit(127);
    }
    ASSERT_GT(server, 0);
    std::string told;
    char some[4096];
    for (ssize_t bytes = 0; (bytes = ::read(terminal, some, sizeof some)) > 0;) {
        told.append(some, static_cast<std::size_t>(bytes));
    }
    ::close(terminal);
    int status = -1;
    ::waitpid(server, &status, 0);
    EXPECT_EQ(status, 0);
    for (std::string const step : {"reading", "meshes"}) {
        std::regex const whole(step + R"( +\[#{16}\] 100%  \d+\.\d s\x1b\[K\r\n)");
        EXPECT_TRUE(std::regex_search(told, whole)) << told;
    }
}

TEST(Operation, OptionsComeFromAFileToo) {
    TemporaryFolder const folder;
    std::string const file = folder.write("server.toml", "scene = \"" + scene_file + "\"\nport = 1\npaused = true\n");
    ServerProcess const server =
        ServerProcess::of_program(FRAMELET_SERVER, {"--config", file, "--port", "0", "--insecure"});
    std::string const client_file =
        folder.write("client.toml", "host = \"" + server.address() + "\"\nsize = \"64x64\"\njson = true\n");
    Process client(FRAMELET_CLIENT, {"--config", client_file, "--until-converged"});
    EXPECT_EQ(client.wait(patience), 0) << client.errors();
    EXPECT_EQ(nlohmann::json::parse(client.output())["width"], 64);

    Process wrong(FRAMELET_SERVER, {scene_file, "--config", folder.write("wrong.toml", "prot = 7070\n")});
    EXPECT_EQ(wrong.wait(patience), 2);
    EXPECT_TRUE(has(wrong.errors(), "wrong.toml") && has(wrong.errors(), "'prot'")) << wrong.errors();
    Process absent(FRAMELET_CLIENT, {"--config", (folder.path() / "absent.toml").string()});
    EXPECT_EQ(absent.wait(patience), 1);
    EXPECT_TRUE(has(absent.errors(), "absent.toml")) << absent.errors();
}

/// Niceness of a program's first thread; those that it starts have it from there.
int niceness(pid_t pid) {
    return ::getpriority(PRIO_PROCESS, static_cast<id_t>(pid));
}

TEST(Operation, AServerGivesWayToOtherProgramsUnlessToldOtherwise) {
    int const own = ::getpriority(PRIO_PROCESS, 0);
    ServerProcess by_itself(scene_file);
    EXPECT_EQ(niceness(by_itself.process().pid()), std::max(own, 5));
    ServerProcess told(scene_file, {"--nice", "0"});
    EXPECT_EQ(niceness(told.process().pid()), std::max(own, 0));
    Process wrong(FRAMELET_SERVER, {scene_file, "--nice", "20"});
    EXPECT_EQ(wrong.wait(patience), 2);
    EXPECT_TRUE(has(wrong.errors(), "0 to 19")) << wrong.errors();
}

/// Resident memory of a process, MB.
double resident_megabytes(pid_t pid) {
    std::ifstream file("/proc/" + std::to_string(pid) + "/status");
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("VmRSS:")) {
            return std::stod(line.substr(6)) / 1000;
        }
    }
    return 0;
}

TEST(Operation, WhatViewersHadThatHaveLeftIsGivenBack) {
#ifdef FRAMELET_SANITIZE
    GTEST_SKIP() << "the sanitizer keeps what is freed";
#endif
    ServerProcess server(scene_file, {"--paused"});
    auto const after_viewers = [&](std::size_t count) {
        std::deque<Process> viewers;
        for (std::size_t i = 0; i < count; ++i) {
            viewers.emplace_back(FRAMELET_CLIENT,
                                 std::vector<std::string>{server.address(), "--size", "640x360", "--duration", "3"});
        }
        for (Process& viewer : viewers) {
            EXPECT_EQ(viewer.wait(patience), 0) << viewer.errors();
        }
        return resident_megabytes(server.process().pid());
    };
    double const one = after_viewers(1);
    EXPECT_GT(one, 10);
    after_viewers(8);
    after_viewers(8);
    EXPECT_TRUE(eventually([&] { return resident_megabytes(server.process().pid()) < one + 40; }))
        << resident_megabytes(server.process().pid()) << " MB, with one viewer " << one;
}

TEST(Operation, PrometheusAndHealthChecksAreAnswered) {
    ServerProcess server(scene_file, {"--paused", "--insecure", "--metrics", "0"});
    std::string const address = metrics_address(server);
    ASSERT_TRUE(address.starts_with("127.0.0.1:")) << address;
    EXPECT_EQ(ask(address, "/health").body(), "ok\n");
    std::string const before = ask(address, "/metrics").body();
    EXPECT_EQ(metric(before, "framelet_sent_bytes_total"), 0) << before;
    Process client(FRAMELET_CLIENT, {server.address(), "--size", "64x64", "--until-converged"});
    ASSERT_EQ(client.wait(patience), 0) << client.errors();
    auto const page = ask(address, "/metrics");
    EXPECT_TRUE(has(std::string(page[http::field::content_type]), "version=0.0.4"));
    for (char const* const name : {"framelet_sent_bytes_total", "framelet_rays_total", "framelet_rays_per_second",
                                   "framelet_busy_seconds_total", "process_resident_memory_bytes"}) {
        EXPECT_GT(metric(page.body(), name), 0) << name << " in\n" << page.body();
        EXPECT_TRUE(has(page.body(), std::string("# TYPE ") + name)) << name;
    }
    EXPECT_EQ(metric(page.body(), "framelet_viewers_total"), 1);
    EXPECT_EQ(metric(page.body(), "framelet_scene_loads_total"), 1);
    EXPECT_EQ(ask(address, "/").result(), http::status::not_found);
    EXPECT_EQ(ask(address, "/metrics", http::verb::post).result(), http::status::method_not_allowed);
}

TEST(Operation, WhoAsksWithoutEndKeepsNobodyFromTheScene) {
    ServerProcess server(scene_file, {"--paused", "--insecure", "--metrics", "0"});
    std::string const address = metrics_address(server);
    boost::asio::io_context io;
    std::vector<tcp::socket> silent;
    for (int i = 0; i < 40; ++i) {
        silent.push_back(connected(io, address));
    }
    boost::system::error_code error;
    silent.front().send(boost::asio::buffer(std::string(100000, 'x')), 0, error);
    Process client(FRAMELET_CLIENT, {server.address(), "--size", "64x64", "--until-converged"});
    EXPECT_EQ(client.wait(patience), 0) << client.errors();
    EXPECT_EQ(ask(address, "/health").result(), http::status::ok) << "while the others are there";
    server.process().signal(SIGTERM);
    EXPECT_EQ(server.process().wait(30s), 0);
}

TEST(Operation, AMetricsPortThatCannotBeHadIsSaidAtOnce) {
    ServerProcess first(scene_file, {"--paused", "--metrics", "0"});
    std::string const address = metrics_address(first);
    Process second(FRAMELET_SERVER, {"absent.glb", "--port", "0", "--metrics", address.substr(address.rfind(':') + 1)});
    EXPECT_EQ(second.wait(patience), 1);
    EXPECT_TRUE(has(second.errors(), "--metrics")) << second.errors();
    Process alone(FRAMELET_SERVER, {scene_file, "--metrics-bind", "127.0.0.1"});
    EXPECT_EQ(alone.wait(patience), 2);
}

} // namespace
} // namespace framelet::test
