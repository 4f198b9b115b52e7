// A screen that nobody sees, and the real programs on it, with keys and clicks that come from the X server as a
// keyboard's and a mouse's do. What they did is read from what the programs say and write.
#pragma once

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/loopback/process.h"

namespace framelet::test {

inline std::string content_of(std::filesystem::path const& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

inline bool has(std::string const& text, std::string const& part) {
    return text.find(part) != std::string::npos;
}

class WindowFixture : public testing::Test {
protected:
    static constexpr std::chrono::seconds patience{120};
    static constexpr int screen_width = 640, screen_height = 480;

    void SetUp() override {
        if (!std::filesystem::exists("/usr/bin/Xvfb") || !std::filesystem::exists("/usr/bin/xdotool")) {
            GTEST_SKIP() << "there is no Xvfb, or no xdotool";
        }
        // Without -noreset a program that comes while the last one leaves finds no screen.
        screen_.emplace("/usr/bin/Xvfb",
                        std::vector<std::string>{"-displayfd", "1", "-noreset", "-screen", "0", "640x480x24", "-fbdir",
                                                 screen_folder_.path().string()});
        ASSERT_TRUE(eventually([&] { return has(screen_->output(), "\n") || !screen_->running(); }));
        ::setenv("DISPLAY", (":" + screen_->output().substr(0, screen_->output().find('\n'))).c_str(), 1);
        ::unsetenv("WAYLAND_DISPLAY");
        ::setenv("XDG_STATE_HOME", folder_.path().c_str(), 1);
        ::setenv("XDG_CONFIG_HOME", folder_.path().c_str(), 1);
        std::signal(SIGHUP, SIG_DFL); // also where the tests run under nohup
    }

    /// Starts a program in the folder of the test, in place of the one before.
    void start(std::string const& program, std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), {"-c", "cd \"$0\" && exec \"$@\"", folder_.path().string(), program});
        program_.emplace("/bin/sh", arguments);
    }

    /// Gives the X server input, in xdotool's words.
    static void input(std::vector<std::string> const& words) {
        Process tool("/usr/bin/xdotool", words);
        EXPECT_EQ(tool.wait(patience), 0) << tool.errors();
    }
    /// Presses a key. One that the window may not see yet, or that comes too early, is to be pressed again.
    void press(std::string const& key) {
        input({"key", key});
        EXPECT_TRUE(program_->running()) << program_->errors();
    }
    static void click(int x, int y) {
        input({"mousemove", std::to_string(x), std::to_string(y), "sleep", "0.1", "mousedown", "1", "sleep", "0.1",
               "mouseup", "1", "sleep", "0.1"});
    }
    /// Types into the field that has the keys, in place of what is there, and Enter.
    static void enter(std::string const& text) {
        input({"key", "--delay", "100", "ctrl+a"});
        input({"type", "--delay", "20", text});
        input({"key", "--delay", "200", "Return"});
    }

    /// Waits until the program's window is there, and some frames more.
    bool has_window() {
        bool const is_there = eventually([&] {
            Process search("/usr/bin/xdotool", {"search", "--onlyvisible", "--name", "framelet-viewer"});
            return search.wait(patience) == 0 || !program_->running();
        });
        std::this_thread::sleep_for(std::chrono::seconds(1));
        return is_there && program_->running();
    }

    std::string memory() const { return content_of(folder_.path() / "framelet" / "viewer.json"); }

    std::vector<std::filesystem::path> saved(std::string const& ending) const {
        std::vector<std::filesystem::path> out;
        for (auto const& entry : std::filesystem::directory_iterator(folder_.path())) {
            if (entry.path().filename().string().ends_with(ending)) {
                out.push_back(entry.path());
            }
        }
        return out;
    }

    TemporaryFolder folder_;
    TemporaryFolder screen_folder_; ///< the X server writes what is on its screen into a file there
    std::optional<Process> screen_;
    std::optional<Process> program_;
};

} // namespace framelet::test
