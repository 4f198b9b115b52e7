#include "client/frames/frame_log.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "common/error.h"

namespace framelet {
namespace {

TEST(FrameLog, EachLineCanBeReadAtOnce) {
    auto const file = std::filesystem::temp_directory_path() / ("framelet-frame-log-" + std::to_string(getpid()));
    FrameLog log(file);
    for (std::uint64_t frame = 0; frame < 3; ++frame) {
        Camera camera;
        camera.position = {1, 2, 3};
        log.add(
            {frame, 1.7e9 + 0.125 * static_cast<double>(frame), 2.5, frame == 1, true, 77, 0.25, 512, 0.5, -1, camera});
        std::ifstream stream(file);
        std::string line;
        for (std::uint64_t i = 0; i <= frame; ++i) {
            ASSERT_TRUE(std::getline(stream, line));
        }
        auto const read = nlohmann::json::parse(line);
        EXPECT_EQ(read["frame"], frame);
        EXPECT_EQ(read["unix_seconds"], 1.7e9 + 0.125 * static_cast<double>(frame));
        EXPECT_EQ(read["scene_seconds"], 2.5);
        EXPECT_EQ(read["changed"], frame == 1);
        EXPECT_EQ(read["complete"], true);
        EXPECT_EQ(read["bytes"], 77);
        EXPECT_EQ(read["cpu_seconds"], 0.25);
        EXPECT_EQ(read["samples"], 512);
        EXPECT_EQ(read["photon_seconds"], 0.5);
        EXPECT_EQ(read["scene_camera"], -1);
        EXPECT_EQ(read["position"], (nlohmann::json{1, 2, 3}));
    }
    std::filesystem::remove(file);
}

TEST(FrameLog, AFileThatCannotBeWrittenIsRefused) {
    EXPECT_THROW(FrameLog("/nonexistent/frames.jsonl"), InputError);
    FrameLog full("/dev/full");
    EXPECT_THROW(full.add({}), InputError);
}

} // namespace
} // namespace framelet
