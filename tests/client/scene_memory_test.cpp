#include "client/window/kept/scene_memory.h"

#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>

#include "tests/client/own_folder.h"

namespace framelet {
namespace {

TEST(SceneMemory, IsOfOneSceneFile) {
    OwnFolder const folder;
    ASSERT_EQ(::setenv("XDG_STATE_HOME", folder.path().c_str(), 1), 0); // each case is a process of its own
    EXPECT_EQ(read_scene_memory("mill", 1), SceneMemory());
    write_scene_memory("mill", 1, {-1.25f});
    write_scene_memory("mill", 2, {3});
    EXPECT_EQ(read_scene_memory("mill", 1).exposure_ev, -1.25f);
    EXPECT_EQ(read_scene_memory("mill", 2).exposure_ev, 3);
    EXPECT_EQ(read_scene_memory("mill", 0), SceneMemory());
    EXPECT_EQ(read_scene_memory("../mill", 1), SceneMemory());
}

TEST(SceneMemory, WhatMakesNoSenseIsAsNone) {
    OwnFolder const folder;
    ASSERT_EQ(::setenv("XDG_STATE_HOME", folder.path().c_str(), 1), 0);
    write_scene_memory("mill", 0, {1});
    auto const file = folder.path() / "framelet" / "scenes" / "mill.json";
    ASSERT_TRUE(std::filesystem::exists(file));
    for (char const* const text :
         {"", "{", "[1]", "{\"exposure\": \"1\"}", "{\"exposure\": 17}", "{\"exposure\": 1e99}"}) {
        std::ofstream(file) << text;
        EXPECT_EQ(read_scene_memory("mill", 0), SceneMemory()) << text;
    }
}

} // namespace
} // namespace framelet
