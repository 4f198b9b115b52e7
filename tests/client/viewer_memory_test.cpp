#include "client/window/kept/viewer_memory.h"

#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>

#include "client/core/camera/camera_controller.h"
#include "tests/client/own_folder.h"

namespace framelet {
namespace {

TEST(ViewerMemory, IsTheSameInTheNextRun) {
    OwnFolder const folder;
    ASSERT_EQ(::setenv("XDG_STATE_HOME", folder.path().c_str(), 1), 0); // each case is a process of its own
    EXPECT_EQ(read_viewer_memory(), ViewerMemory());
    ViewerMemory memory{Viewport{1000, 600}, true, true, true, false, {}};
    memory.note_server("render.example:7070");
    memory.note_server("tls://[::1]:80");
    memory.bias = -0.25f;
    memory.lag_seconds = 0.1;
    memory.fly_speed = 1 / CameraController::most_speed_factor;
    write_viewer_memory(memory);
    EXPECT_EQ(read_viewer_memory(), memory);
    EXPECT_EQ(memory.servers.front(), "tls://[::1]:80");
    std::ofstream(folder.path() / "framelet" / "viewer.json") << "{";
    EXPECT_EQ(read_viewer_memory(), ViewerMemory());
}

TEST(ViewerMemory, TheNewestServersStay) {
    ViewerMemory memory;
    for (int i = 0; i < 20; ++i) {
        memory.note_server("host:" + std::to_string(1000 + i));
    }
    memory.note_server("host:1015");
    EXPECT_EQ(memory.servers.size(), ViewerMemory::most_servers);
    EXPECT_EQ(memory.servers[0], "host:1015");
    EXPECT_EQ(memory.servers[1], "host:1019");
}

TEST(ViewerMemory, WhatMakesNoSenseIsLeftOut) {
    ViewerMemory const memory = parse_viewer_memory(
        R"({"size": [5, 99999999999], "fullscreen": "yes", "statistics": true, "servers": ["a:70707", 3, "b", ""],
            "bias": 2, "smooth": -1, "fly_speed": "fast"})");
    EXPECT_EQ(memory.size, std::nullopt);
    EXPECT_FALSE(memory.fullscreen);
    EXPECT_TRUE(memory.shows_statistics);
    EXPECT_TRUE(memory.shows_bar);
    EXPECT_EQ(memory.servers, std::vector<std::string>{"b:7070"});
    EXPECT_EQ(memory.bias, 0);
    EXPECT_EQ(memory.lag_seconds, 0);
    EXPECT_EQ(memory.fly_speed, 1);
    for (char const* const text : {"", "[]", "{\"size\": 3}", "{\"servers\": 3}"}) {
        EXPECT_EQ(parse_viewer_memory(text), ViewerMemory()) << text;
    }
}

} // namespace
} // namespace framelet
