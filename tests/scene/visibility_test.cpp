#include "server/scene/summary/visibility.h"

#include <gtest/gtest.h>

#include "gltf_writer.h"
#include "server/scene/scene_import.h"

namespace framelet {
namespace {

bool visible(std::vector<float> const& positions, std::string const& rest) {
    TemporaryFolder const folder;
    GltfWriter writer;
    writer.array(positions, "VEC3");
    writer.array(std::vector<float>{0, 1}, "SCALAR");
    writer.array(std::vector<float>{0, 0, 0, 1, 1, 1}, "VEC3");
    return has_anything_to_see(import_scene(folder.write("a.gltf", writer.json(rest))));
}

std::string const scene = R"("scenes":[{"nodes":[0]}],)";
std::string const mesh = R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)";

TEST(Visibility, ATriangleIsSeen) {
    EXPECT_TRUE(visible(triangle_positions, one_mesh(R"("attributes":{"POSITION":0})")));
    EXPECT_TRUE(visible(triangle_positions, scene + mesh + R"("nodes":[{"mesh":0,"scale":[1e-6,1e-6,1e-6]}])"));
}

TEST(Visibility, NothingIsNot) {
    EXPECT_FALSE(visible(triangle_positions, scene + mesh + R"("nodes":[{}])")) << "no node shows the mesh";
    EXPECT_FALSE(visible(triangle_positions, one_mesh(R"("attributes":{"POSITION":0},"mode":1)"))) << "lines";
    EXPECT_FALSE(visible(std::vector<float>(9, 1), one_mesh(R"("attributes":{"POSITION":0})"))) << "one point";
    EXPECT_FALSE(visible({0, 0, 0, 1, 1, 1, 2, 2, 2}, one_mesh(R"("attributes":{"POSITION":0})"))) << "one line";
    EXPECT_FALSE(visible(triangle_positions, scene + mesh + R"("nodes":[{"mesh":0,"scale":[0,0,0]}])"));
}

TEST(Visibility, WhatMayGrowCounts) {
    EXPECT_TRUE(
        visible(triangle_positions,
                scene + mesh +
                    R"("nodes":[{"mesh":0,"scale":[0,0,0]}],"animations":[{"samplers":[{"input":1,"output":2}],)"
                    R"("channels":[{"sampler":0,"target":{"node":0,"path":"scale"}}]}])"));
    EXPECT_TRUE(
        visible(std::vector<float>(9, 0), one_mesh(R"("attributes":{"POSITION":0},"targets":[{"POSITION":0}])")));
}

} // namespace
} // namespace framelet
