// Tests of the real window on a screen that nobody sees, with keys that come from the X server as a keyboard's do. What
// they did is read from the files that the window saves into its folder.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/loopback/process.h"

namespace framelet::test {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

std::string const scene_file = FRAMELET_SOURCE_DIR "/scenes/windmill.glb";
constexpr auto patience = 120s;
constexpr int width = 320, height = 200;

std::string content_of(fs::path const& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

class WindowTest : public testing::Test {
protected:
    void SetUp() override {
        if (!fs::exists("/usr/bin/Xvfb") || !fs::exists("/usr/bin/xdotool")) {
            GTEST_SKIP() << "there is no Xvfb, or no xdotool";
        }
        screen_.emplace("/usr/bin/Xvfb", std::vector<std::string>{"-displayfd", "1", "-screen", "0", "640x480x24"});
        ASSERT_TRUE(
            eventually([&] { return screen_->output().find('\n') != std::string::npos || !screen_->running(); }));
        ::setenv("DISPLAY", (":" + screen_->output().substr(0, screen_->output().find('\n'))).c_str(), 1);
        ::unsetenv("WAYLAND_DISPLAY");
        ::setenv("XDG_STATE_HOME", folder_.path().c_str(), 1);
        ::setenv("XDG_CONFIG_HOME", folder_.path().c_str(), 1);
        server_.emplace(scene_file, server_options_);
        viewer_.emplace("/bin/sh", std::vector<std::string>{"-c", "cd \"$0\" && exec \"$@\"", folder_.path().string(),
                                                            FRAMELET_VIEWER, server_->address(), "--size",
                                                            std::to_string(width) + "x" + std::to_string(height),
                                                            "--painter", painter_});
    }

    /// Presses a key. One that the window may not see yet, or that comes too early, is to be pressed again.
    void press(std::string const& key) {
        Process tool("/usr/bin/xdotool", {"key", key});
        EXPECT_EQ(tool.wait(patience), 0) << tool.errors();
        EXPECT_TRUE(viewer_->running()) << viewer_->errors();
    }

    std::vector<fs::path> saved(std::string const& ending) const {
        std::vector<fs::path> out;
        for (auto const& entry : fs::directory_iterator(folder_.path())) {
            if (entry.path().filename().string().ends_with(ending)) {
                out.push_back(entry.path());
            }
        }
        return out;
    }

    /// True where some camera that was saved looks along this axis.
    bool has_looked_along(std::array<double, 3> const& axis) const {
        for (fs::path const& file : saved(".camera.json")) {
            auto const camera = nlohmann::json::parse(content_of(file), nullptr, false);
            if (camera.is_discarded()) {
                continue; // it is being written
            }
            double along = 0, squared = 0;
            for (std::size_t i = 0; i < 3; ++i) {
                double const way = camera.at("target")[i].get<double>() - camera.at("position")[i].get<double>();
                along += way * axis[i];
                squared += way * way;
            }
            if (along > 0.9999 * std::sqrt(squared)) {
                return true;
            }
        }
        return false;
    }

    /// The camera that the window looks from now, as it saves it.
    nlohmann::json newest_camera() {
        auto const before = saved(".camera.json").size();
        std::vector<fs::path> files;
        EXPECT_TRUE(eventually([&] {
            press("shift+c");
            files = saved(".camera.json");
            return files.size() > before;
        }));
        auto const newest = std::ranges::max_element(
            files, {}, [](fs::path const& file) { return std::pair(fs::last_write_time(file), file); });
        nlohmann::json camera;
        EXPECT_TRUE(eventually([&] {
            camera = nlohmann::json::parse(content_of(*newest), nullptr, false);
            return !camera.is_discarded();
        }));
        return camera;
    }

    void move_mouse(int right, int down) {
        Process tool("/usr/bin/xdotool", {"mousemove_relative", "--", std::to_string(right), std::to_string(down)});
        EXPECT_EQ(tool.wait(patience), 0) << tool.errors();
    }

    std::vector<std::string> server_options_{"--paused", "--insecure"};
    std::string painter_ = "auto";
    TemporaryFolder folder_;
    std::optional<Process> screen_;
    std::optional<ServerProcess> server_;
    std::optional<Process> viewer_;
};

TEST_F(WindowTest, TheKeypadLooksAlongAxes) {
    struct View {
        std::string key;
        std::array<double, 3> axis;
    };
    for (View const& view : {View{"KP_3", {-1, 0, 0}}, View{"KP_7", {0, -1, 0}}, View{"KP_1", {0, 0, -1}}}) {
        EXPECT_TRUE(eventually([&] {
            press(view.key);
            press("shift+c");
            return has_looked_along(view.axis);
        })) << view.key;
    }
}

TEST_F(WindowTest, SavesThePictureWithItsDepth) {
    // The lowest line of the picture is the last of the file, and its depths the end of that: there is the ground.
    EXPECT_TRUE(eventually([&] {
        press("shift+F12");
        for (fs::path const& file : saved(".exr")) {
            std::string const bytes = content_of(file);
            std::vector<float> depths(width);
            std::size_t const length = depths.size() * sizeof(float);
            if (bytes.size() < static_cast<std::size_t>(height) * 4 * length) {
                continue; // before the shapes had come, or while it is being written
            }
            std::memcpy(depths.data(), bytes.data() + bytes.size() - length, length);
            if (std::ranges::all_of(depths, [](float depth) { return depth > 1 && depth < 1000; })) {
                return true;
            }
        }
        return false;
    }));
}

TEST_F(WindowTest, TheMouseLooksAroundUntilEscapeEndsThat) {
    EXPECT_TRUE(eventually([&] {
        press("KP_1"); // and no camera of the scene any more
        press("shift+c");
        return has_looked_along({0, 0, -1});
    }));
    nlohmann::json const before = newest_camera();
    nlohmann::json camera;
    EXPECT_TRUE(eventually([&] {
        press("m");
        for (int i = 0; i < 10; ++i) {
            move_mouse(20, 0);
        }
        camera = newest_camera();
        if (camera == before) { // mouse look is off again, where the first key was seen late
            return false;
        }
        press("Escape");
        return true;
    }));
    for (std::size_t i = 0; i < 3; ++i) { // keys that came late may have looked along the axis once more
        EXPECT_NEAR(camera["position"][i].get<double>(), before["position"][i].get<double>(), 1e-3);
        EXPECT_NEAR(camera["up"][i].get<double>(), before["up"][i].get<double>(), 1e-3);
    }
    // The camera looks to the right of -Z.
    EXPECT_GT(camera["target"][0].get<double>() - camera["position"][0].get<double>(), 0.1);
    nlohmann::json const still = newest_camera(); // after Escape, and the window is still there
    move_mouse(-50, 0);
    EXPECT_EQ(newest_camera(), still);
}

TEST_F(WindowTest, KeepsBookmarksForTheSceneFile) {
    fs::path const folder = folder_.path() / "framelet" / "cameras";
    std::string name;
    EXPECT_TRUE(eventually([&] {
        press("b");
        if (!fs::exists(folder)) {
            return false;
        }
        name = fs::directory_iterator(folder)->path().filename().string();
        return name.ends_with(".json");
    }));
    EXPECT_TRUE(name.starts_with("windmill-")) << name;
    EXPECT_EQ(name.size(), std::string("windmill-0123456789abcdef.json").size()) << name;
}

/// OpenGL paints what moves here, also where it is a program on the processor.
class PaintedWindowTest : public WindowTest {
protected:
    PaintedWindowTest() {
        server_options_ = {"--insecure"};
        painter_ = "gpu";
    }
};

TEST_F(PaintedWindowTest, SavesWhatTheGraphicsCardHasPainted) {
    EXPECT_TRUE(eventually([&] {
        press("shift+F12");
        for (fs::path const& file : saved(".exr")) {
            // The picture's last line: blue, green, red, depth.
            std::string const bytes = content_of(file);
            std::vector<float> line(4 * width);
            std::size_t const length = line.size() * sizeof(float);
            if (bytes.size() < static_cast<std::size_t>(height) * length) {
                continue;
            }
            std::memcpy(line.data(), bytes.data() + bytes.size() - length, length);
            if (std::all_of(line.end() - width, line.end(), [](float depth) { return depth > 1 && depth < 1000; }) &&
                std::all_of(line.begin(), line.end() - width, [](float light) { return light > 0 && light <= 1; })) {
                return true;
            }
        }
        return false;
    }));
    EXPECT_EQ(viewer_->errors().find("processor paints"), std::string::npos) << viewer_->errors();
}

} // namespace
} // namespace framelet::test
