// The real window with a session on the windmill. What hands did is read from the files that the window saves into its
// folder, and from the screen.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/camera.h"
#include "common/image.h"
#include "tests/launcher/window_fixture.h"

namespace framelet::test {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

inline std::string const scene_file = FRAMELET_SOURCE_DIR "/scenes/windmill.glb";
constexpr int width = 320, height = 200;

class WindowTest : public WindowFixture {
protected:
    void SetUp() override {
        WindowFixture::SetUp();
        if (IsSkipped()) {
            return;
        }
        server_.emplace(scene_file, server_options_);
        start_viewer();
    }

    void start_viewer() {
        start(FRAMELET_VIEWER,
              {server_->address(), "--size", std::to_string(size_.width) + "x" + std::to_string(size_.height),
               "--painter", painter_});
    }

    /// True once a condition holds; false where it is better to try again what is to bring it about.
    static bool soon(std::function<bool()> const& holds) {
        for (int i = 0; i < 100; ++i) {
            if (holds()) {
                return true;
            }
            std::this_thread::sleep_for(20ms);
        }
        return false;
    }

    /// What is on the screen now.
    Picture screen() const {
        // The file is in the format of xwd: a head of numbers, big-endian, a table of colours, and rows of BGRX.
        std::string const file = content_of(screen_folder_.path() / "Xvfb_screen0");
        auto const byte = [&](std::size_t i) { return static_cast<std::uint8_t>(i < file.size() ? file[i] : '\0'); };
        auto const number = [&](std::size_t i) {
            return static_cast<int>(byte(4 * i) << 24 | byte(4 * i + 1) << 16 | byte(4 * i + 2) << 8 | byte(4 * i + 3));
        };
        Picture out(std::clamp(number(4), 1, 10000), std::clamp(number(5), 1, 10000));
        auto const first = static_cast<std::size_t>(number(0) + 12 * number(19));
        for (int y = 0; y < out.height; ++y) {
            std::size_t at = first + static_cast<std::size_t>(y) * static_cast<std::size_t>(number(12));
            for (int x = 0; x < out.width; ++x, at += 4) {
                for (std::size_t k = 0; k < 3; ++k) {
                    out.row(y)[4 * x + static_cast<int>(k)] = byte(at + 2 - k);
                }
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
            return soon([&] {
                files = saved(".camera.json");
                return files.size() > before;
            });
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

    static void move_mouse(int right, int down) {
        input({"mousemove_relative", "--", std::to_string(right), std::to_string(down)});
    }

    std::vector<std::string> server_options_{"--paused", "--insecure"};
    std::string painter_ = "auto";
    Viewport size_{width, height};
    std::optional<ServerProcess> server_;
};

} // namespace framelet::test
