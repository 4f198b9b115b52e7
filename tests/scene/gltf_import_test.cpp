#include "server/scene/scene_import.h"

#include <gtest/gtest.h>

#include "common/error.h"
#include "common/files/picture_writer.h"
#include "gltf_writer.h"
#include "server/scene/motion/animation.h"

namespace framelet {
namespace {

Scene import_text(std::string const& text, TemporaryFolder const& folder = TemporaryFolder()) {
    return import_scene(folder.write("a.gltf", text));
}

/// A file with a single triangle as mesh 0 and whatever else.
Scene import_triangle(std::string const& rest) {
    GltfWriter writer;
    writer.array(triangle_positions, "VEC3");
    return import_text(writer.json(R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)" + rest));
}

TEST(GltfImport, StripsAndFansBecomeLists) {
    for (auto const& [mode, expected] : std::vector<std::pair<int, std::vector<std::array<std::uint32_t, 3>>>>{
             {4, {{0, 1, 2}}}, {5, {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}}, {6, {{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}}}) {
        GltfWriter writer;
        writer.array(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0}, "VEC3");
        writer.array(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
        Scene const scene = import_text(
            writer.json(one_mesh(R"("attributes":{"POSITION":0,"NORMAL":1},"mode":)" + std::to_string(mode))));
        EXPECT_EQ(scene.meshes[0].primitives[0].triangles, expected) << "mode " << mode;
    }
}

TEST(GltfImport, PointsAndLinesArePassedOverWithAWarning) {
    GltfWriter writer;
    writer.array(triangle_positions, "VEC3");
    Scene const scene = import_text(writer.json(one_mesh(R"("attributes":{"POSITION":0},"mode":1)")));
    EXPECT_TRUE(scene.meshes[0].primitives.empty());
    ASSERT_FALSE(scene.warnings.empty());
    EXPECT_NE(scene.warnings[0].find("points and lines"), std::string::npos);
}

TEST(GltfImport, FlatNormalsWhereThereAreNone) {
    GltfWriter writer;
    writer.array(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3");
    writer.array(std::vector<std::uint8_t>{0, 1, 2, 0, 3, 1}, "SCALAR", GltfWriter::u8);
    Primitive const p =
        import_text(writer.json(one_mesh(R"("attributes":{"POSITION":0},"indices":1)"))).meshes[0].primitives[0];
    ASSERT_EQ(p.positions.size(), 6u) << "no vertex is shared";
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(p.normals[p.triangles[0][i]], Vec3(0, 0, 1));
        EXPECT_EQ(p.normals[p.triangles[1][i]], Vec3(0, 1, 0));
    }
}

TEST(GltfImport, TheAssetSaysHowItWantsToBeLit) {
    GltfWriter writer;
    writer.array(triangle_positions, "VEC3");
    std::string const text = writer.json(one_mesh(R"("attributes":{"POSITION":0})"));
    auto const light_of = [&](std::string const& extras) {
        std::string with_extras = text;
        std::string const version = R"("version":"2.0")";
        with_extras.insert(with_extras.find(version) + version.size(), extras);
        return import_text(with_extras).light;
    };
    EXPECT_EQ(light_of(""), "");
    EXPECT_EQ(light_of(R"(,"extras":{"framelet_light":"direct"})"), "direct");
    for (char const* const other :
         {R"(,"extras":{"framelet_light":3})", R"(,"extras":["framelet_light"])", R"(,"extras":null)",
          R"(,"more":{"extras":{"framelet_light":"full"}})", R"(,"extras":{"extras":{"framelet_light":"full"}})"}) {
        EXPECT_EQ(light_of(other), "") << other;
    }
}

TEST(GltfImport, OfVeryManyCamerasTheFirstAreTaken) {
    std::string nodes = R"("nodes":[{"mesh":0})";
    std::string roots = "0";
    for (int i = 1; i <= 5000; ++i) {
        nodes += R"(,{"camera":0})";
        roots += "," + std::to_string(i);
    }
    Scene const scene =
        import_triangle(R"("cameras":[{"type":"perspective","perspective":{"yfov":0.6,"znear":0.1}}],)" + nodes +
                        R"(],"scene":0,"scenes":[{"nodes":[)" + roots + "]}]");
    EXPECT_EQ(scene.cameras.size(), 4096u);
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_EQ(scene.warnings[0], "it has 5000 cameras; the first 4096 can be chosen");
}

TEST(GltfImport, NodesParentsFirstOnlyOfTheDefaultScene) {
    Scene const scene = import_triangle(
        R"("scene":1,"scenes":[{"nodes":[0]},{"nodes":[3]}],)"
        R"("nodes":[{"name":"other","mesh":0},{"name":"leaf","mesh":0,"translation":[0,0,1]},)"
        R"({"name":"leaf2","mesh":0,"matrix":[2,0,0,0, 0,2,0,0, 0,0,2,0, 5,6,7,1]},)"
        R"({"name":"root","children":[1,2],"translation":[10,0,0],"rotation":[0,0.70710678,0,0.70710678],"scale":[2,2,2]}])");
    ASSERT_EQ(scene.nodes.size(), 3u);
    EXPECT_EQ(scene.nodes[0].name, "root");
    EXPECT_EQ(scene.nodes[1].parent, 0);
    EXPECT_EQ(scene.nodes[1].mesh, scene.nodes[2].mesh) << "instances share a mesh";
    EXPECT_EQ(scene.meshes.size(), 1u);
    ScenePose const pose = evaluate_pose(scene, {}, 0);
    Vec3 const leaf(pose.world_from_node[1][3]);
    EXPECT_NEAR(glm::distance(leaf, Vec3(12, 0, 0)), 0, 1e-5f) << "T * R * S: z goes to x, twice as long";
    EXPECT_NEAR(glm::distance(Vec3(pose.world_from_node[2][3]), Vec3(24, 12, -10)), 0, 1e-4f);
}

TEST(GltfImport, OtherScenesAreNamedAndCanBeChosen) {
    TemporaryFolder const folder;
    GltfWriter writer;
    writer.array(triangle_positions, "VEC3");
    auto const file = folder.write(
        "a.gltf", writer.json(R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"scene":1,"scenes":[)"
                              R"({"nodes":[0]},{"name":"day","nodes":[1]},{"name":"night","nodes":[2]},)"
                              R"({"name":"0","nodes":[3]}],"nodes":[{"name":"a","mesh":0},{"name":"b","mesh":0},)"
                              R"({"name":"c","mesh":0},{"name":"d","mesh":0}])"));
    Scene const said = import_scene(file);
    EXPECT_EQ(said.nodes.at(0).name, "b");
    ASSERT_EQ(said.warnings.size(), 1u);
    EXPECT_EQ(said.warnings[0], "scene 1 'day' is shown; --scene shows another: 0, 2 'night', 3 '0'");
    ImportOptions options;
    for (auto const& [wanted, node] : {std::pair("night", "c"), {"2", "c"}, {"1", "b"}, {"0", "d"}, {"3", "d"}}) {
        options.scene = wanted;
        Scene const scene = import_scene(file, {}, options);
        EXPECT_EQ(scene.nodes.at(0).name, node) << wanted << ": a name goes before a number";
        EXPECT_TRUE(scene.warnings.empty()) << wanted;
    }
    for (char const* const wanted : {"4", "-1", "dusk", "01"}) {
        options.scene = wanted;
        try {
            import_scene(file, {}, options);
            ADD_FAILURE() << wanted;
        } catch (InputError const& error) {
            EXPECT_NE(
                std::string(error.what())
                    .find(std::string("there is no scene '") + wanted + "' in it; it has 0, 1 'day', 2 'night', 3 '0'"),
                std::string::npos)
                << error.what();
        }
    }
    EXPECT_THROW(import_scene(folder.write("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), {}, options), InputError);
}

TEST(GltfImport, AllRootsWhereThereIsNoScene) {
    EXPECT_EQ(import_triangle(R"("nodes":[{"children":[1]},{"mesh":0},{"mesh":0}])").nodes.size(), 3u);
}

TEST(GltfImport, CamerasAndLights) {
    Scene const scene = import_triangle(
        R"("extensionsUsed":["KHR_lights_punctual"],"extensions":{"KHR_lights_punctual":{"lights":[)"
        R"({"type":"spot","color":[1,0.5,0],"intensity":20,"range":9,"spot":{"innerConeAngle":0.1,"outerConeAngle":0.4}},)"
        R"({"type":"directional","intensity":3}]}},)"
        R"("cameras":[{"type":"perspective","perspective":{"yfov":0.6,"znear":0.1,"aspectRatio":1.5}},)"
        R"({"type":"orthographic","orthographic":{"xmag":4,"ymag":2,"znear":0,"zfar":10}}],)"
        R"("nodes":[{"camera":0,"translation":[0,1,2]},{"camera":1,"rotation":[0,1,0,0]},)"
        R"({"extensions":{"KHR_lights_punctual":{"light":0}}},{"extensions":{"KHR_lights_punctual":{"light":1}}},)"
        R"({"extensions":{"KHR_lights_punctual":{"light":1}}}])");
    ASSERT_EQ(scene.cameras.size(), 2u);
    EXPECT_FLOAT_EQ(scene.cameras[0].vertical_extent, 0.6f);
    EXPECT_EQ(scene.cameras[1].projection, Projection::orthographic);
    EXPECT_FLOAT_EQ(scene.cameras[1].vertical_extent, 4);
    ASSERT_EQ(scene.lights.size(), 3u) << "a light is placed by every node that has it";
    EXPECT_EQ(scene.lights[0].type, LightType::spot);
    EXPECT_EQ(scene.lights[0].color, Vec3(1, 0.5f, 0));
    EXPECT_FLOAT_EQ(scene.lights[0].intensity, 20);
    EXPECT_FLOAT_EQ(scene.lights[0].range, 9);
    EXPECT_FLOAT_EQ(scene.lights[0].inner_cone, 0.1f);
    EXPECT_FLOAT_EQ(scene.lights[0].outer_cone, 0.4f);
    EXPECT_EQ(scene.lights[2].type, LightType::directional);
    EXPECT_EQ(scene.lights[2].node, 4);
}

TEST(GltfImport, MaterialsTexturesAndExtensions) {
    TemporaryFolder const folder;
    Picture picture(2, 1);
    picture.rgba = {255, 0, 0, 255, 0, 0, 255, 255};
    write_png(folder.path() / "a picture.png", picture);
    GltfWriter writer;
    writer.array(triangle_positions, "VEC3");
    std::string const text = writer.json(
        one_mesh(R"("attributes":{"POSITION":0},"material":0)") +
        R"(,"images":[{"uri":"a%20picture.png"},{"uri":"missing.png"}],)"
        R"("samplers":[{"magFilter":9728,"wrapS":33071,"wrapT":33648}],)"
        R"("textures":[{"source":1},{"source":0,"sampler":0},{"source":0}],)"
        R"("extensionsUsed":["KHR_texture_transform","FANCY_unknown"],)"
        R"("materials":[{"name":"m","doubleSided":true,"alphaMode":"MASK","alphaCutoff":0.25,"emissiveFactor":[0.5,1,0],)"
        R"("extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":4},"KHR_materials_unlit":{},)"
        R"("KHR_materials_transmission":{"transmissionFactor":0.75,"transmissionTexture":{"index":2}}},)"
        R"("normalTexture":{"index":0,"scale":2},"occlusionTexture":{"index":2,"strength":0.5,"texCoord":1},)"
        R"("pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,0.3,0.4],"metallicFactor":0.5,"roughnessFactor":0.25,)"
        R"("baseColorTexture":{"index":1,"texCoord":0,"extensions":{"KHR_texture_transform":)"
        R"({"offset":[0.5,0.25],"scale":[2,3],"rotation":1.5,"texCoord":1}}}}}])");
    Scene const scene = import_text(text, folder);
    ASSERT_EQ(scene.images.size(), 1u) << "stored once, the missing one dropped";
    EXPECT_EQ(*scene.images[0], picture);
    ASSERT_EQ(scene.textures.size(), 2u);
    EXPECT_TRUE(scene.textures[0].nearest);
    EXPECT_EQ(scene.textures[0].wrap_u, Wrap::clamp);
    EXPECT_EQ(scene.textures[0].wrap_v, Wrap::mirror);
    EXPECT_FALSE(scene.textures[1].nearest);
    Material const& m = scene.materials.at(0);
    EXPECT_EQ(m.base_color, Vec4(0.1f, 0.2f, 0.3f, 0.4f));
    EXPECT_EQ(m.metallic, 0.5f);
    EXPECT_EQ(m.roughness, 0.25f);
    EXPECT_EQ(m.emissive, Vec3(2, 4, 0));
    EXPECT_EQ(m.alpha_mode, AlphaMode::mask);
    EXPECT_EQ(m.alpha_cutoff, 0.25f);
    EXPECT_TRUE(m.double_sided && m.unlit);
    EXPECT_EQ(m.transmission, 0.75f);
    EXPECT_EQ(m.transmission_texture.texture, 1);
    EXPECT_EQ(m.normal_texture.texture, none);
    EXPECT_EQ(m.occlusion_texture.uv_set, 1);
    EXPECT_EQ(m.occlusion_strength, 0.5f);
    TextureUse const& use = m.base_color_texture;
    EXPECT_EQ(use.texture, 0);
    EXPECT_EQ(use.uv_set, 1);
    EXPECT_EQ(use.offset, Vec2(0.5f, 0.25f));
    EXPECT_EQ(use.scale, Vec2(2, 3));
    EXPECT_EQ(use.rotation, 1.5f);
    EXPECT_EQ(scene.meshes[0].primitives[0].uv[1].size(), 3u) << "coordinates that are used but missing are 0";
    std::string const warnings = scene.warnings.at(0) + "\n" + scene.warnings.at(1);
    EXPECT_NE(warnings.find("missing.png"), std::string::npos) << warnings;
    EXPECT_NE(warnings.find("FANCY_unknown"), std::string::npos) << warnings;
}

TEST(GltfImport, TextureTransformAsTheExtensionSays) {
    TextureUse use;
    use.texture = 0;
    use.offset = {0.5f, 0};
    use.scale = {2, 1};
    use.rotation = 1.5707963f;
    // translation * rotation * scale with rotation = [cos sin; -sin cos]
    Vec2 const uv = transform_uv(use, {1, 3});
    EXPECT_NEAR(uv.x, 3.5f, 1e-5f);
    EXPECT_NEAR(uv.y, -2, 1e-5f);
}

TEST(GltfImport, SkinWeightsAreNormalisedAndTheFourLargestKept) {
    GltfWriter writer;
    writer.array(triangle_positions, "VEC3");
    writer.array(std::vector<std::uint8_t>{0, 1, 2, 3, 0, 1, 2, 3, 0, 0, 0, 0}, "VEC4", GltfWriter::u8);
    writer.array(std::vector<float>{0.5f, 0.5f, 0.5f, 0.5f, 0.1f, 0.2f, 0.3f, 0, 0, 0, 0, 0}, "VEC4");
    writer.array(std::vector<std::uint16_t>{4, 0, 0, 0, 4, 5, 0, 0, 9, 9, 9, 9}, "VEC4", GltfWriter::u16);
    writer.array(std::vector<float>{0, 0, 0, 0, 0.4f, 0.6f, 0, 0, 0, 0, 0, 0}, "VEC4");
    Scene const scene = import_text(writer.json(
        R"("nodes":[{"mesh":0,"skin":0},{},{},{},{},{},{}],"skins":[{"joints":[1,2,3,4,5,6]}],"meshes":[{"primitives":[)"
        R"({"attributes":{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2,"JOINTS_1":3,"WEIGHTS_1":4}}]}])"));
    auto const& influences = scene.meshes[0].primitives[0].influences;
    ASSERT_EQ(influences.size(), 3u);
    EXPECT_EQ(influences[0].weights, (std::array<float, 4>{0.25f, 0.25f, 0.25f, 0.25f}));
    EXPECT_EQ(influences[1].joints, (std::array<std::uint16_t, 4>{5, 4, 2, 1}));
    EXPECT_NEAR(influences[1].weights[0], 0.4f, 1e-6f);
    EXPECT_NEAR(influences[1].weights[3], 0.2f / 1.5f, 1e-6f);
    EXPECT_EQ(influences[2].joints, (std::array<std::uint16_t, 4>{}));
    EXPECT_EQ(influences[2].weights, (std::array<float, 4>{1, 0, 0, 0}));
    EXPECT_EQ(scene.skins[0].inverse_bind_matrices, std::vector<Mat4>(6, Mat4(1)))
        << "identity where the file has none";
}

TEST(GltfImport, MorphTargetsAndTheirDefaults) {
    GltfWriter writer;
    writer.array(triangle_positions, "VEC3");
    writer.array(std::vector<float>{0, 0, 1, 0, 0, 0, 0, 0, 0}, "VEC3");
    Scene const scene =
        import_text(writer.json(R"("nodes":[{"mesh":0},{"mesh":0,"weights":[0.25,1]}],"meshes":[{"weights":[0.5,0],)"
                                R"("primitives":[{"attributes":{"POSITION":0},"targets":[{"POSITION":1},{}]}]}])"));
    Primitive const& p = scene.meshes[0].primitives[0];
    ASSERT_EQ(p.morph_targets.size(), 2u);
    EXPECT_EQ(p.morph_targets[0].positions[0], Vec3(0, 0, 1));
    EXPECT_TRUE(p.morph_targets[1].positions.empty());
    ScenePose const pose = evaluate_pose(scene, {}, 0);
    EXPECT_EQ(pose.morph_weights[0], (std::vector<float>{0.5f, 0}));
    EXPECT_EQ(pose.morph_weights[1], (std::vector<float>{0.25f, 1}));
}

TEST(GltfImport, AnimationsOfAllKinds) {
    GltfWriter writer;
    writer.array(triangle_positions, "VEC3");
    writer.array(std::vector<float>{0, 2}, "SCALAR");
    writer.array(std::vector<float>{0, 0, 0, 4, 0, 0}, "VEC3");
    writer.array(std::vector<float>{0, 0, 0, 1, 1, 1, 0, 0, 0, 0, 0, 0, 5, 5, 5, 0, 0, 0}, "VEC3");
    writer.array(std::vector<std::int16_t>{0, 0, 0, 32767, 0, 32767, 0, 0}, "VEC4", GltfWriter::i16,
                 R"(,"normalized":true)");
    Scene const scene = import_text(writer.json(
        R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}],"animations":[{"name":"go",)"
        R"("samplers":[{"input":1,"output":2,"interpolation":"STEP"},{"input":1,"output":3,"interpolation":"CUBICSPLINE"},)"
        R"({"input":1,"output":4}],"channels":[{"sampler":0,"target":{"node":0,"path":"translation"}},)"
        R"({"sampler":1,"target":{"node":0,"path":"scale"}},{"sampler":2,"target":{"node":0,"path":"rotation"}}]}])"));
    ASSERT_EQ(scene.clips.size(), 1u);
    AnimationClip const& clip = scene.clips[0];
    EXPECT_EQ(clip.name, "go");
    EXPECT_EQ(clip.duration, 2);
    ASSERT_EQ(clip.channels.size(), 3u);
    EXPECT_EQ(clip.channels[0].interpolation, Interpolation::step);
    EXPECT_EQ(clip.channels[1].interpolation, Interpolation::cubic_spline);
    EXPECT_EQ(clip.channels[1].values.size(), 18u);
    EXPECT_EQ(clip.channels[2].property, AnimatedProperty::rotation);
    EXPECT_EQ(clip.channels[2].values[3], 1);
    ScenePose const pose = evaluate_pose(scene, default_clips(scene), 1);
    EXPECT_NEAR(glm::distance(pose.world_from_node[0] * Vec4(1, 0, 0, 1), Vec4(0, 0, -3, 1)), 0, 1e-4f)
        << "stays at the origin, three times as large, turned by a quarter";
}

TEST(GltfImport, ProgressIsToldFromStartToEnd) {
    TemporaryFolder const folder;
    GltfWriter writer;
    writer.array(triangle_positions, "VEC3");
    std::vector<std::pair<std::string, double>> told;
    import_scene(folder.write("a.gltf", writer.json(one_mesh(R"("attributes":{"POSITION":0})"))),
                 [&](std::string_view what, double fraction) { told.emplace_back(what, fraction); });
    ASSERT_GE(told.size(), 3u);
    EXPECT_EQ(told.front(), std::pair(std::string("reading"), 0.0));
    EXPECT_EQ(told.back(), std::pair(std::string("meshes"), 1.0));
}

TEST(GltfImport, AClipThatIsMissingIsFoundOutBeforeMeshesAreRead) {
    TemporaryFolder const folder;
    GltfWriter writer;
    writer.array(triangle_positions, "VEC3");
    std::string const file = folder.write("a.gltf", writer.json(one_mesh(R"("attributes":{"POSITION":7})")));
    ImportOptions options;
    auto const complaint = [&] {
        try {
            import_scene(file, {}, options);
            return std::string();
        } catch (InputError const& error) {
            return std::string(error.what());
        }
    };
    EXPECT_NE(complaint(), "") << "there is no accessor 7";
    EXPECT_EQ(complaint().find("clip"), std::string::npos) << complaint();
    options.clips = {"walk"};
    EXPECT_NE(complaint().find("no clip 'walk'"), std::string::npos) << complaint();
}

TEST(GltfImport, BinaryAndLongerBufferFile) {
    TemporaryFolder const folder;
    GltfWriter writer;
    writer.array(triangle_positions, "VEC3");
    std::string const rest = one_mesh(R"("attributes":{"POSITION":0})");
    EXPECT_EQ(import_scene(folder.write("a.glb", writer.glb(rest))).meshes[0].primitives[0].triangles.size(), 1u);
    std::string text = writer.json(rest, false);
    text.replace(text.find(R"("byteLength":36)"), 15, R"("byteLength":36,"uri":"b%2Ebin")");
    std::string data(reinterpret_cast<char const*>(triangle_positions.data()), 36);
    folder.write("b.bin", data + "padding");
    EXPECT_EQ(import_scene(folder.write("b.gltf", text)).meshes[0].primitives[0].positions[1], Vec3(1, 0, 0));
}

} // namespace
} // namespace framelet
