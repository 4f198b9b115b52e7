// Extensions of glTF that say what there is to see, and what is said of those that are not read.
#include "server/scene/scene_import.h"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "common/error.h"
#include "gltf_writer.h"
#include "server/scene/motion/animation.h"

namespace framelet {
namespace {

Scene import_text(std::string const& text, ImportOptions const& options = {}) {
    TemporaryFolder const folder;
    return import_scene(folder.write("a.gltf", text), {}, options);
}

std::string lines_of(Scene const& scene) {
    return std::accumulate(scene.warnings.begin(), scene.warnings.end(), std::string(),
                           [](std::string const& text, std::string const& line) { return text + line + "\n"; });
}

std::string const triangle_mesh = R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)";

/// Where the corner (1, 0, 0) of each mesh is shown, in the order of nodes.
std::vector<Vec3> corners(Scene const& scene, SceneTime time = 0) {
    ScenePose const pose = evaluate_pose(scene, default_clips(scene), time);
    std::vector<Vec3> out;
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        if (scene.nodes[i].mesh != none) {
            out.emplace_back(pose.world_from_node[i] * Vec4(1, 0, 0, 1));
        }
    }
    return out;
}

void expect_near(std::vector<Vec3> const& found, std::vector<Vec3> const& right) {
    ASSERT_EQ(found.size(), right.size());
    for (std::size_t i = 0; i < right.size(); ++i) {
        EXPECT_NEAR(glm::distance(found[i], right[i]), 0, 1e-4f) << "corner " << i;
    }
}

/// Accessors: 0 a triangle, 1 translations, 2 rotations as bytes, 3 scales, 4 two times, 5 two translations, 6 two
/// numbers.
GltfWriter instance_writer() {
    GltfWriter writer;
    writer.array(triangle_positions, "VEC3");
    writer.array(std::vector<float>{-1.5f, 0, 0, 0, 0, 0, 1.5f, 0, 0}, "VEC3");
    writer.array(std::vector<std::int8_t>{0, 0, 0, 127, 0, 0, 90, 90, 0, 0, 0, 127}, "VEC4", GltfWriter::i8,
                 R"(,"normalized":true)");
    writer.array(std::vector<float>{1, 1, 1, 2, 2, 2, 0.5f, 1, 1}, "VEC3");
    writer.array(std::vector<float>{0, 1}, "SCALAR");
    writer.array(std::vector<float>{0, 0, 0, 0, 8, 0}, "VEC3");
    return writer;
}

std::string instanced(std::string const& attributes, std::string const& more = "") {
    return R"("nodes":[{"mesh":0,"translation":[0,0,5])" + more +
           R"(,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{)" + attributes + "}}}}]";
}

TEST(GltfInstancing, EachInstanceHasItsPlace) {
    Scene const scene = import_text(instance_writer().json(
        R"("extensionsUsed":["EXT_mesh_gpu_instancing"],"extensionsRequired":["EXT_mesh_gpu_instancing"],)" +
        triangle_mesh + instanced(R"("TRANSLATION":1,"ROTATION":2,"SCALE":3,"_ID":6)")));
    expect_near(corners(scene), {{-0.5f, 0, 5}, {0, 2, 5}, {2, 0, 5}});
    EXPECT_EQ(scene.meshes.size(), 1u) << "which they share";
    EXPECT_EQ(lines_of(scene), "");
}

TEST(GltfInstancing, InstancesMoveWithTheirNode) {
    Scene const scene = import_text(instance_writer().json(
        triangle_mesh + instanced(R"("TRANSLATION":1)") +
        R"(,"animations":[{"samplers":[{"input":4,"output":5}],"channels":[{"sampler":0,"target":{"node":0,)"
        R"("path":"translation"}}]}])"));
    expect_near(corners(scene, 0.5), {{-0.5f, 4, 0}, {1, 4, 0}, {2.5f, 4, 0}});
}

TEST(GltfInstancing, WithoutAttributesThereIsTheMeshItself) {
    Scene const scene = import_text(instance_writer().json(triangle_mesh + instanced("")));
    expect_near(corners(scene), {{1, 0, 5}});
}

TEST(GltfInstancing, WhatIsWrongWithThemLeavesTheMesh) {
    for (auto const& [attributes, part] :
         {std::pair<std::string, std::string>{R"("TRANSLATION":77)", "node 0: accessor 77"},
          {R"("TRANSLATION":2)", "node 0: accessor 2 has 4 components"},
          {R"("TRANSLATION":1,"SCALE":5)", "node 0: it has 3 instances, but 2 scales"},
          {R"("TRANSLATION":5,"SCALE":1)", "node 0: it has 3 instances, but 2 translations"}}) {
        Scene const scene = import_text(instance_writer().json(triangle_mesh + instanced(attributes)));
        expect_near(corners(scene), {{1, 0, 5}});
        EXPECT_NE(lines_of(scene).find(part), std::string::npos) << lines_of(scene);
    }
}

TEST(GltfInstancing, InstancesAreCountedBeforeTheyAreMade) {
    GltfWriter writer = instance_writer();
    int const zeros = writer.accessor(R"("componentType":5126,"count":1000000,"type":"VEC3")");
    ImportOptions options;
    options.memory_bytes = 100 << 20;
    EXPECT_THROW(
        import_text(writer.json(triangle_mesh + instanced(R"("TRANSLATION":)" + std::to_string(zeros))), options),
        InputError);
}

TEST(GltfVisibility, WhatIsHiddenShowsNothingBelowIt) {
    Scene const scene = import_text(instance_writer().json(
        R"("extensionsUsed":["KHR_node_visibility"],)" + triangle_mesh +
        R"("cameras":[{"type":"perspective","perspective":{"yfov":0.6,"znear":0.1}}],)"
        R"("extensions":{"KHR_lights_punctual":{"lights":[{"type":"point"}]}},"scenes":[{"nodes":[0,1,4]}],"nodes":[)"
        R"({"mesh":0,"extensions":{"KHR_node_visibility":{"visible":true}}},)"
        R"({"mesh":0,"children":[2,3],"extensions":{"KHR_node_visibility":{"visible":false}}},)"
        R"({"mesh":0,"camera":0,"extensions":{"KHR_node_visibility":{"visible":true}}},)"
        R"({"extensions":{"KHR_lights_punctual":{"light":0}}},)"
        R"({"mesh":0,"extensions":{"KHR_node_visibility":{}}}])"));
    std::vector<bool> shown;
    for (Node const& node : scene.nodes) {
        shown.push_back(node.mesh != none);
    }
    EXPECT_EQ(shown, (std::vector<bool>{true, false, false, false, true}));
    EXPECT_TRUE(scene.lights.empty());
    EXPECT_EQ(scene.cameras.size(), 1u) << "cameras stay";
    EXPECT_EQ(lines_of(scene), "");
}

Material import_material(std::string const& material) {
    return import_text(instance_writer().json(one_mesh(R"("attributes":{"POSITION":0},"material":0)",
                                                       R"(,"materials":[)" + material + "]")))
        .materials.at(0);
}

TEST(GltfSpecularGlossiness, DiffuseIsTheBaseColour) {
    Material const m =
        import_material(R"({"extensions":{"KHR_materials_pbrSpecularGlossiness":{"diffuseFactor":[0.5,0.1,0.2,0.75],)"
                        R"("specularFactor":[0.04,0.04,0.04],"glossinessFactor":0.25}}})");
    EXPECT_EQ(m.base_color, Vec4(0.5f, 0.1f, 0.2f, 0.75f));
    EXPECT_EQ(m.metallic, 0);
    EXPECT_EQ(m.roughness, 0.75f);
}

TEST(GltfSpecularGlossiness, ItsTextureIsThatOfTheBaseColour) {
    // Of one pixel each, as PNG, which is stored by its view.
    std::string const png =
        "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVQI12P4z8AAAAMBAQAY3Y2wAAAAAElFTkSuQmCC";
    Scene const scene = import_text(instance_writer().json(
        one_mesh(R"("attributes":{"POSITION":0},"material":0)",
                 R"(,"images":[{"uri":"data:image/png;base64,)" + png +
                     R"("}],"textures":[{"source":0},{"source":0}],)"
                     R"("materials":[{"pbrMetallicRoughness":{},"extensions":{"KHR_materials_pbrSpecularGlossiness":{)"
                     R"("diffuseTexture":{"index":1,"texCoord":1},"specularGlossinessTexture":{"index":0}}}}])")));
    Material const& m = scene.materials.at(0);
    EXPECT_EQ(m.base_color_texture.texture, 1);
    EXPECT_EQ(m.base_color_texture.uv_set, 1);
    EXPECT_EQ(m.roughness, 1) << "where its texture says how rough it is";
}

TEST(GltfSpecularGlossiness, MetallicRoughnessThatIsThereGoesBeforeIt) {
    Material const m =
        import_material(R"({"pbrMetallicRoughness":{"baseColorFactor":[0,1,0,1],"metallicFactor":0.5},"extensions":)"
                        R"({"KHR_materials_pbrSpecularGlossiness":{"diffuseFactor":[1,0,0,1]}}})");
    EXPECT_EQ(m.base_color, Vec4(0, 1, 0, 1));
    EXPECT_EQ(m.metallic, 0.5f);
}

TEST(GltfExtensions, WarningsSayWhatIsMissing) {
    for (auto const& [name, part] :
         {std::pair<std::string, std::string>{"KHR_materials_clearcoat", "clear coats are missing"},
          {"KHR_texture_basisu", "textures in KTX2 are missing"},
          {"KHR_materials_pbrSpecularGlossiness", "specular colours are missing"},
          {"KHR_animation_pointer", "stands still"},
          {"FANCY_unknown", "what it adds is missing"}}) {
        Scene const scene = import_text(instance_writer().json(
            one_mesh(R"("attributes":{"POSITION":0})", R"(,"extensionsUsed":[")" + name + "\"]")));
        ASSERT_EQ(scene.warnings.size(), 1u) << name;
        EXPECT_NE(scene.warnings[0].find("extension " + name + " is "), std::string::npos) << scene.warnings[0];
        EXPECT_NE(scene.warnings[0].find(part), std::string::npos) << scene.warnings[0];
    }
}

} // namespace
} // namespace framelet
