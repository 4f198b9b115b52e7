// Tests of framelet with the real server, and with a viewer that needs no display: a script in its place. With the real
// viewer where there is Xvfb to show it.
#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <sstream>
#include <thread>

#include <gtest/gtest.h>

#include "tests/loopback/process.h"

namespace framelet::test {
namespace {

using namespace std::chrono_literals;

std::string const scene_file = FRAMELET_SOURCE_DIR "/scenes/windmill.glb";
constexpr auto patience = 120s;

bool has(std::string const& text, std::string const& part) {
    return text.find(part) != std::string::npos;
}

bool lives(pid_t pid) {
    return ::kill(pid, 0) == 0;
}

/// A folder with framelet in it, the real server, and this script in place of the viewer. The script has the server's
/// process in $server, the folder in $here.
class Programs {
public:
    explicit Programs(std::string const& viewer) {
        std::filesystem::copy_file(FRAMELET_LAUNCHER, framelet());
        std::filesystem::create_symlink(FRAMELET_SERVER, folder_.path() / "framelet-server");
        std::string const file = folder_.write(
            "framelet-viewer", "#!/bin/sh\nhere=${0%/*}\nread server rest </proc/$PPID/task/$PPID/children\n"
                               "echo \"$@\" >$here/arguments\necho $$ $server >$here/pids.new\n"
                               "mv $here/pids.new $here/pids\n" +
                                   viewer + "\n");
        std::filesystem::permissions(file, std::filesystem::perms::owner_all);
        ::setenv("DISPLAY", ":none", 1); // which only a real viewer would open
    }

    std::filesystem::path framelet() const { return folder_.path() / "framelet"; }
    std::filesystem::path folder() const { return folder_.path(); }

    std::string read(char const* name) const {
        Process cat("/bin/cat", {(folder_.path() / name).string()});
        cat.wait(patience);
        return cat.output();
    }

    bool viewer_runs() const {
        return eventually([&] { return std::filesystem::exists(folder_.path() / "pids"); });
    }
    /// The processes of viewer and server.
    std::pair<pid_t, pid_t> pids() const {
        std::istringstream text(read("pids"));
        std::pair<pid_t, pid_t> out(0, 0);
        text >> out.first >> out.second;
        return out;
    }

private:
    TemporaryFolder folder_;
};

constexpr char const* waiting = "exec sleep 1000";

TEST(View, EndsWithItsWindowAndHandsOnWhatIsAsked) {
    Programs const programs("exit 0");
    Process view(programs.framelet(), {"view", scene_file, "--size", "320x200", "--paused", "--", "--quiet"});
    EXPECT_EQ(view.wait(patience), 0) << view.errors();
    EXPECT_EQ(view.errors(), "");
    std::string const arguments = programs.read("arguments");
    EXPECT_TRUE(arguments.starts_with("--size=320x200 127.0.0.1:")) << arguments;
    EXPECT_GT(programs.pids().second, 0);
    EXPECT_FALSE(lives(programs.pids().second));
}

TEST(View, ShowsSeveralScenesTogether) {
    Programs const programs("exit 0");
    Process view(programs.framelet(), {"view", scene_file, FRAMELET_SOURCE_DIR "/scenes/globe.glb", "--paused"});
    EXPECT_EQ(view.wait(patience), 0) << view.errors();
    EXPECT_TRUE(has(view.errors(), "windmill + globe: ")) << view.errors();
}

TEST(View, AFolderIsListedAndThereIsNoWindow) {
    Programs const programs("exit 0");
    Process view(programs.framelet(), {"view", FRAMELET_SOURCE_DIR "/scenes"});
    EXPECT_EQ(view.wait(patience), 0) << view.errors();
    EXPECT_TRUE(has(view.output(), "/scenes/windmill.glb\n")) << view.output();
    EXPECT_FALSE(std::filesystem::exists(programs.folder() / "arguments"));
}

TEST(View, TellsTheViewerWhatCountsForOtherScenesToo) {
    Programs const programs("exit 0");
    Process view(programs.framelet(), {"view", scene_file, "--allow-outside", "--threads", "1", "--", "--quiet",
                                       "--metrics", "0", "--log", "text", "--exposure=1"});
    EXPECT_EQ(view.wait(patience), 0) << view.errors();
    std::string const arguments = programs.read("arguments");
    std::size_t const begin = arguments.find("--server-option");
    ASSERT_NE(begin, std::string::npos) << arguments;
    EXPECT_EQ(arguments.substr(begin),
              "--server-option=--threads=1 --server-option=--quiet --server-option=--exposure=1\n");
}

TEST(View, HasTheExitCodeOfTheViewerThatFailed) {
    Programs const programs("exit 7");
    Process failed(programs.framelet(), {"view", scene_file});
    EXPECT_EQ(failed.wait(patience), 7);
    Programs const crash("kill -SEGV $$");
    Process crashed(crash.framelet(), {"view", scene_file});
    EXPECT_EQ(crashed.wait(patience), 128 + SIGSEGV);
    EXPECT_TRUE(has(crashed.errors(), "framelet: framelet-viewer was ended by a signal: ")) << crashed.errors();
}

TEST(View, SaysWhereTheServerHasGoneAndEndsTheViewer) {
    Programs const programs(waiting);
    Process view(programs.framelet(), {"view", scene_file});
    ASSERT_TRUE(programs.viewer_runs());
    auto const [viewer, server] = programs.pids();
    ::kill(server, SIGKILL);
    EXPECT_EQ(view.wait(patience), 128 + SIGKILL);
    EXPECT_TRUE(has(view.errors(), "framelet: framelet-server was ended by a signal: Killed")) << view.errors();
    EXPECT_FALSE(lives(viewer));
}

TEST(View, ASignalEndsAllThree) {
    for (int const number : {SIGINT, SIGTERM, SIGHUP}) {
        Programs const programs(waiting);
        Process view(programs.framelet(), {"view", scene_file});
        ASSERT_TRUE(programs.viewer_runs());
        auto const [viewer, server] = programs.pids();
        view.signal(number);
        EXPECT_EQ(view.wait(patience), 0) << view.errors();
        EXPECT_FALSE(lives(viewer) || lives(server));
    }
}

TEST(View, EndsAServerThatItsViewerNeedsNoMore) {
    Programs const programs("exec /bin/bash -c 'needed=${2#--server-needed=}; exec {needed}>&-; "
                            "until [ -e $here/end ]; do sleep 0.1; done; exit 5' bash \"$@\"");
    ::setenv("here", programs.folder().c_str(), 1);
    Process view(programs.framelet(), {"view", scene_file});
    ASSERT_TRUE(programs.viewer_runs());
    auto const [viewer, server] = programs.pids();
    EXPECT_TRUE(eventually([server = server] { return !lives(server); }));
    EXPECT_TRUE(lives(viewer) && view.running());
    std::ofstream(programs.folder() / "end");
    EXPECT_EQ(view.wait(patience), 5) << view.errors();
}

TEST(View, LeavesNobodyBehindWhenItIsKilled) {
    Programs const programs(waiting);
    Process view(programs.framelet(), {"view", scene_file});
    ASSERT_TRUE(programs.viewer_runs());
    auto const pids = programs.pids();
    view.signal(SIGKILL);
    view.wait(patience);
    EXPECT_TRUE(eventually([&pids] { return !lives(pids.first) && !lives(pids.second); }));
}

TEST(View, WhatCannotBeUsedIsOneLineAndAnExitCode) {
    struct Case {
        std::vector<std::string> words;
        int exit_code;
        char const* says;
    };
    Programs const programs(waiting);
    for (auto const& [words, exit_code, says] :
         {Case{{}, 2, "subcommand"}, Case{{"view"}, 2, "SCENE"}, Case{{"view", "a.glb", "b.glb"}, 2, "b.glb"},
          Case{{"view", "--size", "3", "a.glb"}, 2, "\"3\""},
          Case{{"view", "--painter", "3", "a.glb"}, 2, "auto, cpu or gpu"},
          Case{{"view", "absent.glb"}, 1, "absent.glb"}, Case{{"view", "--threads", "x", scene_file}, 2, "'x'"},
          Case{{"view", scene_file, "--", "--clip", "none"}, 1, "'none'"},
          Case{{"view", "--server-config", "absent.toml", scene_file}, 1, "absent.toml"}}) {
        Process view(programs.framelet(), words);
        EXPECT_EQ(view.wait(patience), exit_code) << view.errors();
        EXPECT_TRUE(has(view.errors(), says)) << view.errors();
        EXPECT_EQ(std::ranges::count(view.errors(), '\n'), 1) << view.errors();
    }
    std::filesystem::remove(programs.folder() / "framelet-server");
    ::setenv("PATH", "/nonexistent", 1);
    Process alone(programs.framelet(), {"view", scene_file});
    EXPECT_EQ(alone.wait(patience), 1);
    EXPECT_TRUE(has(alone.errors(), "framelet: cannot find framelet-server")) << alone.errors();
    ::unsetenv("DISPLAY");
    ::unsetenv("WAYLAND_DISPLAY");
    Process dark(programs.framelet(), {"view", scene_file});
    EXPECT_EQ(dark.wait(patience), 1);
    EXPECT_TRUE(has(dark.errors(), "there is no display")) << dark.errors();
}

TEST(View, ShowsTheRealWindow) {
    if (!std::filesystem::exists("/usr/bin/Xvfb")) {
        GTEST_SKIP() << "there is no Xvfb";
    }
    Process screen("/usr/bin/Xvfb", {"-displayfd", "1", "-screen", "0", "640x480x24"});
    ASSERT_TRUE(eventually([&] { return has(screen.output(), "\n") || !screen.running(); }));
    ::setenv("DISPLAY", (":" + screen.output().substr(0, screen.output().find('\n'))).c_str(), 1);
    ::unsetenv("WAYLAND_DISPLAY");
    Process view(FRAMELET_LAUNCHER, {"view", scene_file, "--size", "320x200"});
    EXPECT_TRUE(eventually([&] { return has(view.errors(), "viewer") || !view.running(); })) << view.errors();
    view.signal(SIGINT);
    EXPECT_EQ(view.wait(patience), 0) << view.errors();
}

} // namespace
} // namespace framelet::test
