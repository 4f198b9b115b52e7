#include "server/scene/assimp/assimp_import.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "common/error.h"
#include "common/files/picture_writer.h"
#include "gltf_writer.h"
#include "server/scene/finish/scene_finish.h"
#include "server/scene/motion/animation.h"
#include "server/scene/scene_import.h"

namespace framelet {
namespace {

std::string const quad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";

TEST(ObjImport, MaterialsBecomeMetallicRoughness) {
    TemporaryFolder const folder;
    Picture picture(2, 2);
    picture.rgba.assign(16, 255);
    picture.rgba[0] = 0;
    write_png(folder.path() / "colour.png", picture);
    folder.write("a.mtl", "newmtl shiny\nKd 0.5 0.25 0\nKs 1 1 1\nNs 123\nKe 2 0 0\nd 0.5\nillum 2\n"
                          "newmtl dull\nKd 1 1 1\nKs 0 0 0\nNs 500\nmap_Kd colour.png\n"
                          "newmtl broken\nmap_Kd textures\\nowhere.png\n");
    Scene const scene =
        import_scene(folder.write("a.obj", "mtllib a.mtl\n" + quad + "usemtl shiny\nf 1/1 2/2 3/3 4/4\n" +
                                               "usemtl dull\nf 1/1 2/2 3/3\nusemtl broken\nf 1/1 3/3 4/4\n"));
    auto const find = [&](std::string const& name) {
        for (Material const& material : scene.materials) {
            if (material.name == name) {
                return material;
            }
        }
        return Material{};
    };
    Material const shiny = find("shiny");
    EXPECT_EQ(shiny.base_color, Vec4(0.5f, 0.25f, 0, 0.5f));
    EXPECT_EQ(shiny.alpha_mode, AlphaMode::blend);
    EXPECT_EQ(shiny.metallic, 0);
    EXPECT_NEAR(shiny.roughness, std::pow(2.0f / 125, 0.25f), 1e-4f);
    EXPECT_EQ(shiny.emissive, Vec3(2, 0, 0));
    Material const dull = find("dull");
    EXPECT_EQ(dull.roughness, 1) << "no highlight";
    EXPECT_EQ(dull.alpha_mode, AlphaMode::opaque);
    ASSERT_EQ(dull.base_color_texture.texture, 0);
    EXPECT_EQ(find("broken").base_color_texture.texture, none);
    ASSERT_EQ(scene.images.size(), 1u);
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_NE(scene.warnings[0].find("nowhere.png"), std::string::npos) << scene.warnings[0];
}

TEST(ObjImport, TextureOriginIsTheUpperLeft) {
    TemporaryFolder const folder;
    Primitive const p = import_scene(folder.write("a.obj", quad + "f 1/1 2/2 3/3\n")).meshes.at(0).primitives.at(0);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(p.uv[0][i], Vec2(p.positions[i].x, 1 - p.positions[i].y));
    }
}

TEST(ObjImport, NormalsAreSmoothUpToTheCrease) {
    TemporaryFolder const folder;
    // Three quads along x: the second is 30 degrees steeper than the first, the third 90 degrees steeper than that.
    std::string const text = "v 0 0 0\nv 0 0 -1\nv 1 0 0\nv 1 0 -1\nv 1.866 0.5 0\nv 1.866 0.5 -1\nv 1.366 1.366 0\n"
                             "v 1.366 1.366 -1\nf 1 3 4 2\nf 3 5 6 4\nf 5 7 8 6\n";
    Scene const scene = import_scene(folder.write("a.obj", text));
    Primitive const& p = scene.meshes.at(0).primitives.at(0);
    EXPECT_EQ(p.triangles.size(), 6u);
    EXPECT_EQ(p.positions.size(), 10u) << "the sharp edge has two normals, the soft one one";
    for (std::size_t i = 0; i < p.positions.size(); ++i) {
        if (p.positions[i].x == 1) {
            EXPECT_NEAR(std::atan2(-p.normals[i].x, p.normals[i].y), 0.2618f, 0.01f) << "half of 30 degrees";
        }
    }
}

TEST(ObjImport, OpacityMapsGoIntoTheBaseColour) {
    TemporaryFolder const folder;
    Picture picture(4, 4);
    picture.rgba.assign(64, 255);
    write_png(folder.path() / "colour.png", picture);
    for (std::size_t i = 0; i < 8 * 4; ++i) {
        picture.rgba[i] = i % 4 == 3 ? 255 : 0; // the upper half is black: transparent
    }
    write_png(folder.path() / "mask.png", picture);
    folder.write("a.mtl", "newmtl leaf\nmap_Kd colour.png\nmap_d mask.png\n");
    Scene const scene = import_scene(folder.write("a.obj", "mtllib a.mtl\nusemtl leaf\n" + quad + "f 1/1 2/2 3/3\n"));
    Material const& leaf = scene.materials.at(static_cast<std::size_t>(scene.meshes[0].primitives[0].material));
    EXPECT_EQ(leaf.alpha_mode, AlphaMode::mask);
    Texture const& texture = scene.textures.at(static_cast<std::size_t>(leaf.base_color_texture.texture));
    Picture const& merged = *scene.images.at(static_cast<std::size_t>(texture.image));
    EXPECT_EQ(merged.row(0)[3], 0);
    EXPECT_EQ(merged.row(3)[3], 255);
}

TEST(ObjImport, MissingMaterialFileIsAWarning) {
    TemporaryFolder const folder;
    Scene const scene = import_scene(folder.write("a.obj", "mtllib gone.mtl\n" + quad + "f 1 2 3\n"));
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_NE(scene.warnings[0].find("gone.mtl"), std::string::npos) << scene.warnings[0];
}

TEST(ObjImport, BadFilesAreOneLine) {
    TemporaryFolder const folder;
    for (std::string const text :
         {"v 0 0 0\nv 1 0 0\nf 1 2 9\n", "f 1 2 3\n", "nothing of use\n", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"}) {
        try {
            import_scene(folder.write("a.obj", text));
            ADD_FAILURE() << "loaded: " << text;
        } catch (InputError const& error) {
            EXPECT_NE(std::string(error.what()).find("a.obj"), std::string::npos);
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        }
    }
}

TEST(AssimpImport, OtherFormats) {
    TemporaryFolder const folder;
    Scene const stl =
        import_scene(folder.write("a.stl", "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 "
                                           "0\nvertex 0 1 0\nendloop\nendfacet\nendsolid s\n"));
    EXPECT_EQ(stl.meshes.at(0).primitives.at(0).triangles.size(), 1u);
    Scene const ply = import_scene(folder.write(
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"));
    EXPECT_EQ(ply.meshes.at(0).primitives.at(0).triangles.size(), 2u);
}

/// Whoever opens a pipe waits for somebody to write.
TEST(AssimpImport, APipeInPlaceOfAMaterialFileIsNotWaitedFor) {
    TemporaryFolder const folder;
    ASSERT_EQ(::mkfifo((folder.path() / "a.mtl").c_str(), 0600), 0);
    Scene const scene = import_scene(folder.write("a.obj", "mtllib a.mtl\n" + quad + "f 1 2 3\n"));
    EXPECT_EQ(scene.meshes.size(), 1u);
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_NE(scene.warnings[0].find("a.mtl"), std::string::npos) << scene.warnings[0];
}

TEST(AssimpImport, HeadersThatPromiseMoreThanTheFileHolds) {
    TemporaryFolder const folder;
    auto const ply = [](std::string const& vertices, std::string const& faces) {
        return "ply\nformat ascii 1.0\ncomment element vertex 9\nelement vertex " + vertices +
               "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
               "\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    };
    EXPECT_NO_THROW(import_scene(folder.write("a.ply", ply("3", "1"))));
    std::string const endless = "ply\nformat ascii 1.0\ncomment a header that has no end";
    EXPECT_THROW(import_scene(folder.write("endless.ply", endless)), InputError);
    EXPECT_NO_THROW(import_scene(folder.write("a.off", "OFF\n# a comment\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")));
    for (auto const& [name, text] :
         std::vector<std::pair<std::string, std::string>>{{"b.ply", ply("4000000000", "1")},
                                                          {"c.ply", ply("3", "4000000000")},
                                                          {"d.ply", ply("99999999999999999999", "1")},
                                                          {"b.off", "OFF\n400000000 1 0\n0 0 0\n"},
                                                          {"c.off", "OFF 3 400000000 0\n0 0 0\n"},
                                                          {"d.OFF", "OFF\n# a comment\n\n3\n400000000\n0\n0 0 0\n"}}) {
        try {
            import_scene(folder.write(name, text));
            ADD_FAILURE() << "loaded: " << name;
        } catch (InputError const& error) {
            EXPECT_NE(std::string(error.what()).find("its header promises"), std::string::npos) << error.what();
        }
    }
}

TEST(AssimpImport, FilesTooLargeForTheBudgetAreNotRead) {
    TemporaryFolder const folder;
    auto const file = folder.write("a.obj", quad + "f 1 2 3\n" + std::string(1 << 20, '\n'));
    ImportOptions options;
    EXPECT_NO_THROW(import_scene(file, {}, options));
    options.memory_bytes = 1 << 20;
    EXPECT_THROW(import_scene(file, {}, options), InputError);
}

/// Some files have counts that no header has, or that its check does not find: what Assimp takes for them is bounded
/// all the same.
TEST(AssimpImport, SmallFilesCannotTakeMuchMemory) {
#ifdef FRAMELET_SANITIZE
    GTEST_SKIP() << "the sanitizer ends a program that is refused memory";
#endif
    TemporaryFolder const folder;
    std::string const much = "60000000";
    std::string const corners = "0 0 0\n1 0 0\n0 1 0\n";
    std::string const ply =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
        "z\nelement face 1\nproperty list uint int vertex_indices\nend_header\n";
    ImportOptions options;
    options.memory_bytes = 64 << 20;
    EXPECT_NO_THROW(import_scene(folder.write("a.ply", ply + corners + "3 0 1 2\n"), {}, options));
    for (auto const& [name, text] : std::vector<std::pair<std::string, std::string>>{
             {"b.ply", ply + corners + much + " 0 1 2\n"},
             {"b.off", "OFF\n#" + std::string(5000, 'x') + "\n" + much + " 1 0\n" + corners + "3 0 1 2\n"}}) {
        try {
            import_scene(folder.write(name, text), {}, options);
            ADD_FAILURE() << "loaded: " << name;
        } catch (InputError const& error) {
            bool const is_bounded = std::string(error.what()).find("--scene-memory") != std::string::npos;
            bool const is_unread = std::string(error.what()).find("a face that cannot be read") != std::string::npos;
            EXPECT_TRUE(name == "b.ply" ? is_unread : is_bounded) << error.what();
        }
    }
    EXPECT_NO_THROW(std::make_unique<char[]>(256 << 20)) << "the bound is gone with the import";
}

/// Assimp reads glTF too: whatever it reads must lie where our own importer puts it. (The camera's node is not moved
/// and its picture is square: otherwise Assimp 5.2 reads the camera differently, in glTF only.)
class AssimpAgainstGltf : public testing::Test {
protected:
    AssimpAgainstGltf() {
        GltfWriter writer;
        writer.array(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 2, 0, 1, 2, 0}, "VEC3");
        writer.array(std::vector<std::uint16_t>{0, 1, 2, 2, 1, 3}, "SCALAR", GltfWriter::u16);
        writer.array(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
        writer.array(std::vector<std::uint8_t>{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}, "VEC4", GltfWriter::u8);
        writer.array(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 0.25f, 0.75f, 0, 0, 1, 0, 0, 0}, "VEC4");
        writer.array(std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,
                                        1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1},
                     "MAT4");
        writer.array(std::vector<float>{0, 2}, "SCALAR");
        writer.array(std::vector<float>{0, 0, 0, 1, 0, 0, 0.70710678f, 0.70710678f}, "VEC4");
        writer.array(std::vector<float>{0, 1, 0, 0, 0, 1, 1, 1}, "VEC2");
        std::string const text = writer.glb(
            R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"name":"root","children":[1,2,4,5],"translation":[0,0,1]},)"
            R"({"name":"body","mesh":0,"skin":0,"translation":[50,0,0]},{"name":"low","children":[3],"scale":[2,2,2]},)"
            R"({"name":"high","translation":[0,1,0]},{"name":"eye","camera":0,"rotation":[0,1,0,0]},)"
            R"({"name":"lamp","rotation":[0.70710678,0,0,0.70710678],"extensions":{"KHR_lights_punctual":{"light":0}}}],)"
            R"("extensionsUsed":["KHR_lights_punctual"],"extensions":{"KHR_lights_punctual":{"lights":[{"type":"directional",)"
            R"("color":[1,0.5,0.25],"intensity":1}]}},)"
            R"("cameras":[{"type":"perspective","perspective":{"yfov":0.8,"znear":0.1,"zfar":100,"aspectRatio":1}}],)"
            R"("skins":[{"joints":[2,3],"inverseBindMatrices":5}],"meshes":[{"primitives":[{"attributes":{"POSITION":0,)"
            R"("NORMAL":2,"JOINTS_0":3,"WEIGHTS_0":4,"TEXCOORD_0":8},"indices":1}]}],"animations":[{"name":"bend","samplers":[)"
            R"({"input":6,"output":7}],"channels":[{"sampler":0,"target":{"node":3,"path":"rotation"}}]}])");
        auto const file = folder.write("a.glb", text);
        expected = import_scene(file);
        ImportBudget budget(ImportOptions{}.memory_bytes);
        found = import_assimp(
            file, SceneFolder(file, false), budget, [](std::string_view, double) {}, false);
        finish_scene(found, budget, [](std::string_view, double) {});
    }

    TemporaryFolder folder;
    Scene expected, found;
};

TEST_F(AssimpAgainstGltf, SkinnedAndAnimatedVerticesAreInTheSamePlace) {
    for (double const time : {0.0, 0.7, 1.5}) {
        ScenePose const pose = evaluate_pose(found, default_clips(found), time);
        Bounds const ours = scene_bounds(expected, evaluate_pose(expected, default_clips(expected), time));
        Bounds const theirs = scene_bounds(found, pose);
        EXPECT_NEAR(glm::distance(ours.lower, theirs.lower), 0, 1e-4f) << "at " << time;
        EXPECT_NEAR(glm::distance(ours.upper, theirs.upper), 0, 1e-4f) << "at " << time;
    }
    EXPECT_EQ(found.clips.at(0).name, "bend");
    EXPECT_NEAR(found.clips.at(0).duration, 2, 1e-4f);
    EXPECT_EQ(found.skins.size(), 1u);
}

TEST_F(AssimpAgainstGltf, CamerasLightsAndTextureCoordinates) {
    Camera const ours = scene_camera(expected, evaluate_pose(expected, {}, 0), 0);
    Camera const theirs = scene_camera(found, evaluate_pose(found, {}, 0), 0);
    EXPECT_NEAR(glm::distance(ours.position, theirs.position), 0, 1e-5f);
    EXPECT_NEAR(glm::distance(ours.forward(), theirs.forward()), 0, 1e-5f);
    EXPECT_NEAR(glm::distance(ours.up(), theirs.up()), 0, 1e-5f);
    EXPECT_NEAR(ours.vertical_extent, theirs.vertical_extent, 1e-4f);
    ASSERT_EQ(found.lights.size(), 1u);
    EXPECT_EQ(found.lights[0].type, LightType::directional);
    EXPECT_NEAR(glm::distance(found.lights[0].color, Vec3(1, 0.5f, 0.25f)), 0, 1e-5f);
    auto const direction = [](Scene const& scene) {
        auto const node = static_cast<std::size_t>(scene.lights.at(0).node);
        return -Vec3(evaluate_pose(scene, {}, 0).world_from_node[node][2]);
    };
    EXPECT_NEAR(glm::distance(direction(found), direction(expected)), 0, 1e-5f);
    EXPECT_EQ(found.meshes.at(0).primitives.at(0).uv[0], expected.meshes.at(0).primitives.at(0).uv[0]);
}

} // namespace
} // namespace framelet
