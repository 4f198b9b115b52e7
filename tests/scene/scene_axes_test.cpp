#include "server/scene/scene_axes.h"

#include <cstring>

#include <gtest/gtest.h>

#include "common/error.h"
#include "gltf_writer.h"
#include "server/scene/motion/animation.h"
#include "server/scene/scene_import.h"

namespace framelet {
namespace {

/// A tower 4 high along z, as the STL file of a CAD program.
std::string tower_stl() {
    std::string out(80, ' ');
    auto const append = [&](auto value) { out.append(reinterpret_cast<char const*>(&value), sizeof value); };
    append(std::uint32_t(2));
    for (float const side : {0.0f, 1.0f}) {
        for (float const number : {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f, side, 0.0f, side, 1.0f, 4.0f}) {
            append(number);
        }
        append(std::uint16_t(0));
    }
    return out;
}

Bounds bounds_with(std::string const& up, std::string const& unit, std::string const& ending, std::string const& text) {
    TemporaryFolder const folder;
    ImportOptions options;
    options.up = up;
    options.unit = unit;
    Scene const scene = import_scene(folder.write("a" + ending, text), {}, options);
    return scene_bounds(scene, evaluate_pose(scene, {}, 0));
}

void expect_size(Bounds const& bounds, Vec3 const& size) {
    EXPECT_NEAR(glm::distance(bounds.size(), size), 0, 1e-5f * glm::length(size))
        << bounds.size().x << " " << bounds.size().y << " " << bounds.size().z;
}

TEST(SceneAxes, WhatIsUpInTheFileIsUp) {
    expect_size(bounds_with("y", "m", ".stl", tower_stl()), {1, 1, 4});
    Bounds const up = bounds_with("z", "m", ".stl", tower_stl());
    expect_size(up, {1, 4, 1});
    EXPECT_NEAR(up.lower.y, 0, 1e-6f) << "its foot is below";
    std::string const tall = "v 0 0 0\nv 4 1 0\nv 4 0 1\nf 1 2 3\n";
    Bounds const along_x = bounds_with("x", "m", ".obj", tall);
    expect_size(along_x, {1, 4, 1});
    EXPECT_NEAR(along_x.lower.y, 0, 1e-6f);
}

TEST(SceneAxes, UnitsBecomeMetres) {
    expect_size(bounds_with("y", "mm", ".stl", tower_stl()), {0.001f, 0.001f, 0.004f});
    expect_size(bounds_with("z", "ft", ".stl", tower_stl()), {0.3048f, 1.2192f, 0.3048f});
    for (auto const& [word, metres] :
         {std::pair("mm", 0.001), {"cm", 0.01}, {"m", 1.0}, {"km", 1000.0}, {"in", 0.0254}}) {
        EXPECT_EQ(parse_unit(word), metres);
    }
}

TEST(SceneAxes, OtherWordsAreRefused) {
    for (char const* const word : {"", "Z", "w", "-z", "xy", "2"}) {
        EXPECT_THROW(parse_up_axis(word), InputError) << word;
    }
    for (char const* const word : {"", "M", "meter", "1", "-1"}) {
        EXPECT_THROW(parse_unit(word), InputError) << word;
    }
}

TEST(SceneAxes, AxesKeepTheirHandedness) {
    for (int const axis : {0, 1, 2}) {
        Scene scene;
        scene.nodes.resize(1);
        orient_scene(scene, axis, 1);
        Mat3 const turned(evaluate_pose(scene, {}, 0).world_from_node.back());
        EXPECT_NEAR(glm::determinant(turned), 1, 1e-6f) << axis;
        EXPECT_NEAR(turned[axis].y, 1, 1e-6f) << axis;
    }
}

/// Everything of a scene that names a node, below a root with an animation.
TEST(SceneAxes, AllThatIsInASceneGoesAlong) {
    GltfWriter writer;
    writer.array(triangle_positions, "VEC3");
    writer.array(std::vector<std::uint8_t>(12, 0), "VEC4", GltfWriter::u8);
    writer.array(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
    writer.array(std::vector<float>{0, 1}, "SCALAR");
    writer.array(std::vector<float>{0, 0, 0, 0, 0, 8}, "VEC3");
    std::string const text = writer.json(
        R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2}}]}],"nodes":[)"
        R"({"mesh":0,"skin":0},{"children":[2,3]},{"camera":0},{"extensions":{"KHR_lights_punctual":{"light":0}}}],)"
        R"("skins":[{"joints":[1]}],"cameras":[{"type":"orthographic","orthographic":{"xmag":2,"ymag":2}}],)"
        R"("extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","intensity":100,"range":50}]}},)"
        R"("animations":[{"samplers":[{"input":3,"output":4}],"channels":[{"sampler":0,"target":{"node":1,)"
        R"("path":"translation"}}]}])");
    TemporaryFolder const folder;
    ImportOptions options;
    options.up = "z";
    options.unit = "cm";
    Scene const scene = import_scene(folder.write("a.gltf", text), {}, options);
    ScenePose const pose = evaluate_pose(scene, default_clips(scene), 0.5);
    Bounds const skinned = scene_bounds(scene, pose);
    EXPECT_NEAR(glm::distance(skinned.lower, Vec3(0, 0.04f, -0.01f)), 0, 1e-6f);
    EXPECT_NEAR(glm::distance(skinned.upper, Vec3(0.01f, 0.04f, 0)), 0, 1e-6f);
    Camera const camera = scene_camera(scene, pose, 0);
    EXPECT_NEAR(glm::distance(camera.position, Vec3(0, 0.04f, 0)), 0, 1e-6f);
    EXPECT_NEAR(glm::distance(camera.forward(), Vec3(0, -1, 0)), 0, 1e-5f) << "along the file's -z";
    EXPECT_NEAR(camera.vertical_extent, 0.04f, 1e-6f);
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_NEAR(scene.lights[0].intensity, 0.01f, 1e-6f);
    EXPECT_NEAR(scene.lights[0].range, 0.5f, 1e-6f);
    EXPECT_NEAR(pose.world_from_node[static_cast<std::size_t>(scene.lights[0].node)][3].y, 0.04f, 1e-6f);
}

} // namespace
} // namespace framelet
