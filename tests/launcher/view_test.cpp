// Tests of framelet: of what it hands on with a script in place of the viewer, which needs no display, and of the rest
// with the real programs.
#include <algorithm>
#include <csignal>
#include <sstream>

#include "tests/launcher/window_fixture.h"

namespace framelet::test {
namespace {

std::string const scene_file = FRAMELET_SOURCE_DIR "/scenes/windmill.glb";
constexpr std::chrono::seconds patience(120);

/// The child of a process that has one; 0: it has none.
pid_t child_of(pid_t parent) {
    pid_t out = 0;
    std::ifstream("/proc/" + std::to_string(parent) + "/task/" + std::to_string(parent) + "/children") >> out;
    return out;
}

bool lives(pid_t pid) {
    return ::kill(pid, 0) == 0;
}

/// A folder with framelet in it, and this script in place of the viewer or another program, which has the folder in
/// $here.
class Programs {
public:
    explicit Programs(std::string const& viewer, std::string const& program = "framelet-viewer") {
        std::filesystem::copy_file(FRAMELET_LAUNCHER, framelet());
        std::string const file =
            folder_.write(program, "#!/bin/sh\nhere=${0%/*}\nprintf '%s\\n' \"$@\" >$here/arguments\n" + viewer + "\n");
        std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    }

    std::filesystem::path framelet() const { return folder_.path() / "framelet"; }
    std::filesystem::path viewer() const { return folder_.path() / "framelet-viewer"; }
    std::string arguments() const { return content_of(folder_.path() / "arguments"); }

private:
    TemporaryFolder folder_;
};

TEST(View, BecomesTheViewerAndHandsOnWhatIsAsked) {
    Programs const programs("exit 7");
    Process view(programs.framelet(), {"view", scene_file, "other.glb", "--size", "320x200", "--allow-outside", "--up",
                                       "z", "--threads", "1", "--camera", "c.json", "--viewer-config=a.toml",
                                       "--server-config=b.toml", "--", "--quiet", "--exposure=1"});
    EXPECT_EQ(view.wait(patience), 7) << view.errors();
    EXPECT_EQ(view.errors(), "");
    EXPECT_EQ(programs.arguments(),
              "--size=320x200\n--camera=c.json\n--config=a.toml\n--open=" + scene_file +
                  "\n--open=other.glb\n--needs-scene\n--server-option=--up=z\n--server-option=--allow-outside\n"
                  "--server-option=--threads=1\n--server-option=--config=b.toml\n--server-option=--quiet\n"
                  "--server-option=--exposure=1\n");
}

TEST(View, WithWebBecomesTheServer) {
    Programs const programs("exit 5", "framelet-server");
    Process view(programs.framelet(), {"view", "--web", scene_file, "--up", "z", "--", "--quiet"});
    EXPECT_EQ(view.wait(patience), 5) << view.errors();
    EXPECT_EQ(programs.arguments(), "--browser\n--port=0\n--up=z\n--quiet\n--\n" + scene_file + "\n");
}

struct Misuse {
    std::vector<std::string> words;
    int exit_code;
    char const* says;
};

/// What cannot be used is one line and an exit code.
void expect_line(std::string const& program, Misuse const& misuse) {
    Process view(program, misuse.words);
    EXPECT_EQ(view.wait(patience), misuse.exit_code) << view.errors();
    EXPECT_TRUE(has(view.errors(), misuse.says)) << view.errors();
    EXPECT_EQ(std::ranges::count(view.errors(), '\n'), 1) << view.errors();
}

TEST(View, ACommandLineOfNoUseIsOneLineAndAnExitCode) {
    Programs const programs("exit 0");
    for (Misuse const& misuse : {Misuse{{}, 2, "subcommand"}, Misuse{{"view"}, 2, "SCENE"},
                                 Misuse{{"view", "--size", "3", "a.glb"}, 2, "\"3\""},
                                 Misuse{{"view", "--painter", "3", "a.glb"}, 2, "auto, cpu or gpu"},
                                 Misuse{{"view", "--web", "--painter", "cpu", "a.glb"}, 2, "--web"}}) {
        expect_line(programs.framelet(), misuse);
    }
    std::filesystem::remove(programs.viewer());
    ::setenv("PATH", "/nonexistent", 1);
    expect_line(programs.framelet(), {{"view", scene_file}, 1, "framelet: cannot find framelet-viewer"});
}

TEST(View, OfAFolderListsTheScenesInItAndBelow) {
    TemporaryFolder const folder;
    std::filesystem::create_directory(folder.path() / "below");
    std::string const below = folder.write("below/car.glb", "");
    std::string const here = folder.write("my house.obj", "");
    Process list(FRAMELET_LAUNCHER, {"view", folder.path().string()});
    EXPECT_EQ(list.wait(patience), 0) << list.errors();
    EXPECT_EQ(list.output(), "framelet view " + below + "\nframelet view '" + here + "'\n");
    EXPECT_EQ(list.errors(), "");
    TemporaryFolder const empty;
    expect_line(FRAMELET_LAUNCHER, {{"view", empty.path().string()}, 1, "no scene file"});
}

TEST(View, SaysThatThereIsNoDisplay) {
    ::unsetenv("DISPLAY");
    ::unsetenv("WAYLAND_DISPLAY");
    expect_line(FRAMELET_LAUNCHER, {{"view", scene_file}, 1, "there is no display"});
}

class ViewTest : public WindowFixture {
protected:
    /// Starts `framelet view` and waits until the window shows the scene.
    void view() {
        start(FRAMELET_LAUNCHER, {"view", scene_file, "--size", "320x200"});
        EXPECT_TRUE(eventually([&] { return has(program_->errors(), "viewer 1 connects") || !program_->running(); }));
        EXPECT_TRUE(program_->running()) << program_->errors();
    }
    pid_t server() const { return child_of(program_->pid()); }
};

TEST_F(ViewTest, ASignalEndsBoth) {
    for (int const number : {SIGINT, SIGTERM, SIGHUP}) {
        view();
        pid_t const served_by = server();
        ASSERT_GT(served_by, 0);
        program_->signal(number);
        EXPECT_EQ(program_->wait(patience), 0) << program_->errors();
        EXPECT_FALSE(lives(served_by));
    }
}

TEST_F(ViewTest, EndsWithItsWindow) {
    view();
    pid_t const served_by = server();
    EXPECT_TRUE(eventually([&] { // a key may come before the window has them
        input({"key", "ctrl+q"});
        return !program_->running();
    }));
    EXPECT_EQ(program_->wait(patience), 0) << program_->errors();
    EXPECT_FALSE(lives(served_by));
}

TEST_F(ViewTest, LeavesNobodyBehindWhenItIsKilled) {
    view();
    pid_t const served_by = server();
    program_->signal(SIGKILL);
    program_->wait(patience);
    EXPECT_TRUE(eventually([&] { return !lives(served_by); }));
}

TEST_F(ViewTest, SaysWhereTheServerHasGoneAndStartsAnother) {
    view();
    ::kill(server(), SIGKILL);
    EXPECT_TRUE(eventually(
        [&] { return has(program_->errors(), "framelet-viewer: framelet-server was ended by a signal: Killed\n"); }));
    EXPECT_TRUE(eventually([&] {
        press("r");
        std::string const said = program_->errors();
        return said.find("viewer 1 connects", said.find("Killed")) != std::string::npos;
    })) << program_->errors();
    ::kill(server(), SIGKILL);
    EXPECT_TRUE(eventually([&] {
        std::string const said = program_->errors();
        return said.find("Killed") != said.rfind("Killed");
    }));
    input({"key", "--delay", "200", "ctrl+q"});
    EXPECT_EQ(program_->wait(patience), 1) << program_->errors();
}

TEST_F(ViewTest, WhatCannotBeOpenedIsOneLineAndAnExitCode) {
    for (Misuse const& misuse : {Misuse{{"view", "absent.glb"}, 1, "framelet-viewer: "},
                                 Misuse{{"view", "--threads", "x", scene_file}, 2, "'x'"},
                                 Misuse{{"view", scene_file, "--", "--clip", "none"}, 1, "'none'"},
                                 Misuse{{"view", "--server-config", "absent.toml", scene_file}, 1, "absent.toml"},
                                 Misuse{{"view", "--viewer-config", "absent.toml", scene_file}, 1, "absent.toml"}}) {
        expect_line(FRAMELET_LAUNCHER, misuse);
    }
    TemporaryFolder const alone;
    for (char const* const program : {FRAMELET_LAUNCHER, FRAMELET_VIEWER}) {
        std::filesystem::copy_file(program, alone.path() / std::filesystem::path(program).filename());
    }
    ::setenv("PATH", "/nonexistent", 1);
    expect_line(alone.path() / "framelet", {{"view", scene_file}, 1, "framelet-viewer: cannot find framelet-server"});
}

} // namespace
} // namespace framelet::test
