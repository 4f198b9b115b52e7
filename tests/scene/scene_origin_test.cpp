#include "server/scene/finish/scene_origin.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "gltf_writer.h"
#include "server/scene/motion/animation.h"
#include "server/scene/scene_import.h"
#include "server/scene/summary/scene_summary.h"

namespace framelet {
namespace {

/// A map's coordinates, and what is placed about there, metres.
glm::dvec3 const utm(500000.25, 100.5, -4649776.75);
std::array<glm::dvec3, 3> const places{glm::dvec3(0, 0, 0), glm::dvec3(1.3, 0.2, 0), glm::dvec3(-1.2, 0.4, 0.3)};

std::string text_of(glm::dvec3 const& v, char const* between) {
    std::array<char, 128> text{};
    std::snprintf(text.data(), text.size(), "%.6f%s%.6f%s%.6f", v.x, between, v.y, between, v.z);
    return text.data();
}

/// Three triangles, one at each of the places from `at`. `below`: nodes stand below one that is at `at`.
Scene gltf_scene(TemporaryFolder const& folder, glm::dvec3 const& at, bool below) {
    GltfWriter writer;
    writer.array(triangle_positions, "VEC3");
    std::string nodes = R"({"children":[1,2,3])" + (below ? R"(,"translation":[)" + text_of(at, ",") + "]" : "") + "}";
    for (glm::dvec3 const& place : places) {
        nodes += R"(,{"mesh":0,"translation":[)" + text_of(below ? place : at + place, ",") + "]}";
    }
    return import_scene(
        folder.write("a.gltf", writer.json(R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[)" + nodes +
                                           R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}])")));
}

Scene obj_scene(TemporaryFolder const& folder, glm::dvec3 const& at) {
    std::string text;
    for (glm::dvec3 const& place : places) {
        for (glm::dvec3 const& corner : {glm::dvec3(0), glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)}) {
            text += "v " + text_of(at + place + corner, " ") + "\n";
        }
        text += "f -3 -2 -1\n";
    }
    return import_scene(folder.write("a.obj", text));
}

std::vector<Vec3> points_of(Scene const& scene) {
    std::vector<Vec3> points;
    ScenePose const pose = evaluate_pose(scene, default_clips(scene), 0);
    DeformedVertices deformed;
    for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
        Node const& node = scene.nodes[n];
        if (node.mesh == none) {
            continue;
        }
        Skin const* const skin = node.skin == none ? nullptr : &scene.skins[static_cast<std::size_t>(node.skin)];
        for (Primitive const& primitive : scene.meshes[static_cast<std::size_t>(node.mesh)].primitives) {
            deform(primitive, pose.morph_weights[n], skin, pose, deformed);
            for (Vec3 const& position : deformed.positions) {
                points.emplace_back((skin ? Mat4(1) : pose.world_from_node[n]) * Vec4(position, 1));
            }
        }
    }
    return points;
}

/// Largest distance between the points of two scenes, the second of which lies farther away by `at`.
double farthest_off(Scene const& near, Scene const& far, glm::dvec3 const& at) {
    std::vector<Vec3> const wanted = points_of(near), found = points_of(far);
    EXPECT_EQ(wanted.size(), found.size());
    double most = 0;
    for (std::size_t i = 0; i < std::min(wanted.size(), found.size()); ++i) {
        most =
            std::max(most, glm::distance(near.origin + glm::dvec3(wanted[i]) + at, far.origin + glm::dvec3(found[i])));
    }
    return most;
}

TEST(SceneOrigin, WhatIsFarAwayIsAsExactAsNear) {
    TemporaryFolder const folder;
    for (bool const below : {true, false}) {
        Scene const near = gltf_scene(folder, {0, 0, 0}, below);
        EXPECT_EQ(near.origin, glm::dvec3(0));
        for (double const scale : {0.004, 0.2, 1.0}) {
            Scene const far = gltf_scene(folder, scale * utm, below);
            EXPECT_LT(farthest_off(near, far, scale * utm), 2e-6) << scale << (below ? ", below" : "");
            EXPECT_LT(glm::length(scale * utm - far.origin), 8) << scale;
        }
    }
    EXPECT_LT(farthest_off(obj_scene(folder, {0, 0, 0}), obj_scene(folder, utm), utm), 2e-6);
}

TEST(SceneOrigin, IsRoundAndStaysWhereTheSceneChangesALittle) {
    glm::dvec3 const centre = round_centre(utm, utm + 2.0);
    EXPECT_EQ(centre, glm::round(centre / 2.0) * 2.0);
    EXPECT_EQ(centre, round_centre(utm, utm + 1.9));
    EXPECT_EQ(round_centre({-1, 0, 0}, {15, 1, 1}), glm::dvec3(0)) << "near for its size";
    EXPECT_EQ(round_centre(utm, utm + 3.0, 1e7), glm::dvec3(0));
    EXPECT_EQ(round_centre(glm::dvec3(NAN), glm::dvec3(1)), glm::dvec3(0));
    EXPECT_NE(round_centre(utm, utm), glm::dvec3(0)) << "a point";
}

/// Vertices about (2^21, 0, 0), which a float keeps to a quarter of a metre, that a node moves or joints move back.
TEST(SceneOrigin, MeshesAboutAnotherPlaceThanTheirNodeAreCentred) {
    Scene scene;
    scene.meshes.resize(1);
    constexpr float far = 2097152;
    Primitive primitive;
    primitive.positions = {{far, 0, 0}, {far + 1, 0, 0}, {far, 1, 0}};
    primitive.triangles = {{0, 1, 2}};
    MorphTarget target;
    target.positions.assign(3, Vec3(0, 0, 0.25f));
    primitive.morph_targets.push_back(target);
    scene.meshes[0].primitives.push_back(primitive);
    scene.meshes[0].morph_weights = {0};
    scene.nodes.resize(1);
    scene.nodes[0].mesh = 0;
    scene.nodes[0].local.translation = {-far, 0, 0};
    scene.clips.push_back(
        {"wave", 1, {{0, AnimatedProperty::morph_weights, Interpolation::linear, 1, {0, 1}, {1, 1}}}});
    std::vector<Vec3> const before = points_of(scene);
    Scene skinned = scene;
    skinned.clips.clear();
    skinned.meshes[0].primitives[0].influences.assign(3, JointInfluence{{}, {1, 0, 0, 0}});
    skinned.skins.push_back({{0}, {Mat4(1)}});
    skinned.nodes[0].skin = 0;
    std::vector<Vec3> const skinned_before = points_of(skinned);

    centre_meshes(scene);
    centre_meshes(skinned);
    ASSERT_EQ(scene.nodes.size(), 2u);
    EXPECT_EQ(points_of(scene), before);
    EXPECT_EQ(points_of(skinned), skinned_before);
    for (Scene const* s : {&scene, &skinned}) {
        for (Vec3 const& position : s->meshes[0].primitives[0].positions) {
            EXPECT_LT(glm::length(position), 4);
        }
    }
}

TEST(SceneOrigin, CamerasAndFiguresAreToldOfIt) {
    TemporaryFolder const folder;
    Scene const scene = gltf_scene(folder, utm, true);
    std::string const text = scene_summary_text(scene, {});
    EXPECT_NE(text.find("far away          about 500000, 100, -4649776 m"), std::string::npos) << text;
    EXPECT_EQ(scene_summary_text(gltf_scene(folder, {0, 0, 0}, true), {}).find("far away"), std::string::npos);
    Bounds const bounds = scene_bounds(scene, evaluate_pose(scene, {}, 0));
    EXPECT_LT(glm::length(default_camera(bounds).position), 20);
}

TEST(SceneOrigin, SeveralFilesHaveOne) {
    TemporaryFolder const folder;
    auto const file = [&](char const* name, glm::dvec3 const& at) {
        return folder.write(name, "v " + text_of(at, " ") + "\nv " + text_of(at + glm::dvec3(1, 0, 0), " ") + "\nv " +
                                      text_of(at + glm::dvec3(0, 1, 0), " ") + "\nf 1 2 3\n");
    };
    std::array<std::filesystem::path, 2> const files{file("a.obj", utm), file("b.obj", utm + glm::dvec3(3, 0, 0))};
    Scene const scene = import_scenes(files);
    std::vector<Vec3> const points = points_of(scene);
    ASSERT_EQ(points.size(), 6u);
    EXPECT_NEAR(glm::distance(points[0], points[3]), 3, 1e-6f);
    EXPECT_LT(glm::length(points[0]), 10);
}

} // namespace
} // namespace framelet
