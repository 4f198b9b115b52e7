#include "scenes/gltf/gltf_writer.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include "scenes/mesh/mesh_builder.h"
#include "server/scene/motion/animation.h"
#include "server/scene/scene_import.h"

namespace framelet {
namespace {

/// The document as the project's own importer reads its file.
Scene imported(GltfDocument const& document) {
    std::string const name = testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::path const file = std::filesystem::path(testing::TempDir()) / (name + ".glb");
    std::ofstream(file, std::ios::binary) << write_glb(document);
    Scene scene = import_scene(file);
    std::filesystem::remove(file);
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
    return scene;
}

/// Positions of the only primitive at a scene time; in world space where a skin moves it.
std::vector<Vec3> positions_at(Scene const& scene, double time) {
    ScenePose const pose = evaluate_pose(scene, default_clips(scene), time);
    DeformedVertices vertices;
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        Node const& node = scene.nodes[i];
        if (node.mesh != none) {
            deform(scene.meshes.at(0).primitives.at(0), pose.morph_weights[i],
                   node.skin == none ? nullptr : &scene.skins[static_cast<std::size_t>(node.skin)], pose, vertices);
        }
    }
    return vertices.positions;
}

/// A card, 2 m high, whose lower edge one joint moves and whose upper edge another, which is 1 m up and turns.
GltfDocument bending_card() {
    GltfDocument document;
    MeshData card = make_card({1, 2});
    for (D3 const& position : card.positions) {
        card.joint_weights.push_back(position.y > 1 ? JointWeights{{1, 7, 0, 0}, {1, 0.0002, 0, 0}}
                                                    : JointWeights{{0, 1, 0, 0}, {0.5, 0.5, 0, 0}});
    }
    int const paint = document.add_material({.name = "paint"});
    int const root = document.add_node({.name = "root", .place = {{5, 0, 0}}});
    int const tip = document.add_node({.name = "tip", .place = {{0, 1, 0}}}, root);
    document.skins.push_back({{root, tip}, {{0, 0, 0}, {0, 1, 0}}});
    document.add_node({.name = "card", .mesh = document.add_mesh("card", {{std::move(card), paint}}), .skin = 0});
    document.tracks.push_back({{tip},
                               GltfPath::rotation,
                               false,
                               {0, 1},
                               {{0, 0, 0, 1}, {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}}); // a quarter about Z
    return document;
}

TEST(GltfWriter, ASkinMovesWhatItsJointsMove) {
    Scene const scene = imported(bending_card());
    std::vector<Vec3> const standing = positions_at(scene, 0);
    std::vector<Vec3> const bent = positions_at(scene, 1 - 1e-6);
    ASSERT_EQ(standing.size(), 4u);
    for (std::size_t i = 0; i < standing.size(); ++i) {
        Vec3 const at = scene.meshes[0].primitives[0].positions[i];
        EXPECT_LT(glm::distance(standing[i], at + Vec3(5, 0, 0)), 1e-5f) << "where the joints stand as it was made";
        Vec3 const turned = Vec3(5, 1, 0) + Vec3(-(at.y - 1), at.x, 0);
        EXPECT_LT(glm::distance(bent[i], at.y > 1 ? turned : glm::mix(standing[i], turned, 128.0f / 255)), 1e-4f);
    }
}

TEST(GltfWriter, WeightsSumToOneAndJointsWithoutWeightAreTheFirst) {
    std::string const bytes = write_glb(bending_card());
    tinygltf::TinyGLTF loader;
    tinygltf::Model model;
    std::string error, warning;
    ASSERT_TRUE(loader.LoadBinaryFromMemory(&model, &error, &warning,
                                            reinterpret_cast<unsigned char const*>(bytes.data()),
                                            static_cast<unsigned int>(bytes.size())))
        << error;
    auto const values = [&](std::string const& attribute) {
        auto const index = model.meshes.at(0).primitives.at(0).attributes.at(attribute);
        tinygltf::Accessor const& accessor = model.accessors.at(static_cast<std::size_t>(index));
        EXPECT_EQ(accessor.componentType, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE);
        EXPECT_EQ(accessor.normalized, attribute == "WEIGHTS_0");
        auto const& view = model.bufferViews.at(static_cast<std::size_t>(accessor.bufferView));
        auto const* const data = model.buffers.at(0).data.data() + view.byteOffset;
        return std::vector<int>(data, data + accessor.count * 4);
    };
    EXPECT_EQ(values("WEIGHTS_0"), (std::vector<int>{127, 128, 0, 0, 127, 128, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0}));
    EXPECT_EQ(values("JOINTS_0"), (std::vector<int>{0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}));
}

TEST(GltfWriter, MorphTargetsAreAddedByTheirWeights) {
    GltfDocument document;
    GltfPrimitive card{make_card({1, 1}), document.add_material({.name = "paint"})};
    for (D3 const way : {D3(0, 0, 2), D3(0, 3, 0), D3(4, 0, 0)}) {
        card.targets.push_back({std::vector<D3>(4, way), std::vector<D3>(4, way)});
    }
    int const node = document.add_node({.name = "card", .mesh = document.add_mesh("card", {card})});
    document.tracks.push_back({{node}, GltfPath::weights, false, {0, 2}, {{0, 1, 0, 9}, {1, 0, 0.5, 9}}});
    Scene const scene = imported(document);
    ASSERT_EQ(scene.meshes.at(0).primitives.at(0).morph_targets.size(), 3u);
    EXPECT_EQ(scene.meshes[0].primitives[0].morph_targets[1].normals[2], Vec3(0, 3, 0));
    Vec3 const moved = positions_at(scene, 1)[0] - scene.meshes[0].primitives[0].positions[0];
    EXPECT_LT(glm::distance(moved, Vec3(1, 1.5, 1)), 1e-5f) << "half of the first two, a quarter of the third";
}

} // namespace
} // namespace framelet
