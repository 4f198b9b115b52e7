// Files that cannot be loaded: each gives one InputError with one line.
#include "server/scene/scene_import.h"

#include <algorithm>
#include <random>

#include <assimp/scene.h>
#include <gtest/gtest.h>

#include "common/error.h"
#include "common/files/image_io.h"
#include "common/files/picture_writer.h"
#include "gltf_writer.h"
#include "server/scene/assimp/assimp_parts.h"
#include "server/scene/motion/animation.h"
#include "server/scene/reading/memory_limit.h"

namespace framelet {
namespace {

std::string import_error(std::filesystem::path const& file, ImportOptions const& options = {}) {
    try {
        import_scene(file, {}, options);
    } catch (InputError const& error) {
        return error.what();
    }
    return "no error";
}

void expect_error(std::filesystem::path const& file, std::string const& part, ImportOptions const& options = {}) {
    std::string const error = import_error(file, options);
    EXPECT_NE(error.find(part), std::string::npos) << error;
    EXPECT_NE(error.find(file.filename().string()), std::string::npos) << "names the file: " << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    EXPECT_LT(error.size(), 600u);
}

GltfWriter triangle_writer() {
    GltfWriter writer;
    writer.array(triangle_positions, "VEC3");
    return writer;
}

std::string const triangle_mesh = R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)";

TEST(BadScene, MissingEmptyDirectoryUnknown) {
    TemporaryFolder const folder;
    expect_error(folder.path() / "nothing.gltf", "no such file");
    expect_error(folder.write("empty.glb", ""), "empty");
    std::filesystem::create_directory(folder.path() / "folder.gltf");
    expect_error(folder.path() / "folder.gltf", "it is a folder");
    expect_error(folder.write("a.unknown", "text"), "format '.unknown' is not known");
    expect_error(folder.write("noextension", "text"), "format '' is not known");
}

TEST(BadScene, BrokenJson) {
    TemporaryFolder const folder;
    expect_error(folder.write("a.gltf", "{\"asset\":"), "JSON is broken");
    expect_error(folder.write("b.gltf", "just text\nof two lines"), "JSON is broken");
    expect_error(folder.write("c.gltf", "[1,2,3]"), "not glTF");
    expect_error(folder.write("d.gltf", R"({"asset":{"version":"1.0"}})"), "glTF version 1.0");
    expect_error(folder.write("e.gltf", R"({"asset":{"version":"2.0"},"extras":)" + std::string(100000, '[') +
                                            std::string(100000, ']') + "}"),
                 "nested too deeply");
}

TEST(BadScene, TruncatedBinaryAtEveryLength) {
    TemporaryFolder const folder;
    std::string const whole = triangle_writer().glb(one_mesh(R"("attributes":{"POSITION":0})"));
    for (std::size_t length = 1; length < whole.size(); ++length) {
        expect_error(folder.write("a.glb", whole.substr(0, length)), "");
    }
    EXPECT_NO_THROW(import_scene(folder.write("a.glb", whole)));
}

TEST(BadScene, MissingAndShortBuffers) {
    TemporaryFolder const folder;
    std::string text = triangle_writer().json(one_mesh(R"("attributes":{"POSITION":0})"), false);
    text.replace(text.find(R"("byteLength":36)"), 15, R"("byteLength":36,"uri":"gone.bin")");
    expect_error(folder.write("a.gltf", text), "gone.bin");
    folder.write("gone.bin", "short");
    expect_error(folder.write("a.gltf", text), "gone.bin");
}

TEST(BadScene, NodesInCircles) {
    TemporaryFolder const folder;
    for (std::string const nodes :
         {R"("scenes":[{"nodes":[0]}],"nodes":[{"children":[1]},{"children":[0]}])", R"("nodes":[{"children":[0]}])",
          R"("scenes":[{"nodes":[0,1]}],"nodes":[{"children":[1]},{"mesh":0}])", R"("nodes":[{"children":[5]}])",
          R"("scenes":[{"nodes":[9]}],"nodes":[{}])", R"("scene":3,"scenes":[{"nodes":[0]}],"nodes":[{}])"}) {
        expect_error(folder.write("a.gltf", triangle_writer().json(triangle_mesh + nodes)), "");
    }
    for (auto const& [nodes, message] : std::vector<std::pair<std::string, std::string>>{
             {R"("scenes":[{"nodes":[0]}],"nodes":[{"children":[1]},{"children":[0]}])", "node 0 is below itself"},
             {R"("scenes":[{"nodes":[0]}],"nodes":[{"name":"a","children":[0]}])", "node 0 'a' is below itself"},
             {R"("nodes":[{"children":[0]}])", "its nodes form a cycle"},
             {R"("scenes":[{"nodes":[0,1]}],"nodes":[{"children":[2]},{"children":[2]},{"name":"door","mesh":0}])",
              "node 2 'door' is reached twice: as a child of node 0 and as a child of node 1"},
             {R"("scenes":[{"nodes":[0,1]}],"nodes":[{"children":[1]},{"mesh":0}])",
              "node 1 is reached twice: as a child of node 0 and in the list of the scene"},
             {R"("scenes":[{"nodes":[0,0]}],"nodes":[{"mesh":0}])",
              "node 0 is reached twice: in the list of the scene and in the list of the scene"},
             {R"("scene":3,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}])",
              "scene 3, which it wants to be shown, does not exist; it has 0 (--scene"}}) {
        expect_error(folder.write("a.gltf", triangle_writer().json(triangle_mesh + nodes)), message);
    }
}

TEST(BadScene, ReferencesToNothing) {
    TemporaryFolder const folder;
    for (auto const& [rest, message] : std::vector<std::pair<std::string, std::string>>{
             {triangle_mesh + R"("nodes":[{"mesh":4}])", "mesh 4 does not exist"},
             {triangle_mesh + R"("nodes":[{"camera":0}])", "camera 0 does not exist"},
             {triangle_mesh + R"("nodes":[{"extensions":{"KHR_lights_punctual":{"light":1}}}])",
              "light 1 does not exist"},
             {R"("meshes":[{"primitives":[{"attributes":{"POSITION":8}}]}],"nodes":[{"mesh":0}])", "accessor 8"},
             {triangle_mesh + R"("nodes":[{}],"skins":[{"joints":[7]}])", "joint node 7 does not exist"},
             {triangle_mesh + R"("nodes":[{}],"animations":[{"samplers":[],"channels":[{"sampler":0,"target":)"
                              R"({"node":0,"path":"scale"}}]}])",
              "sampler 0 does not exist"},
             {triangle_mesh +
                  R"("nodes":[{}],"animations":[{"samplers":[{"input":0,"output":0}],"channels":[{"sampler":0,)"
                  R"("target":{"node":0,"path":"scale"}}]}])",
              "animation 'clip 1'"},
         }) {
        expect_error(folder.write("a.gltf", triangle_writer().json(rest)), message);
    }
}

TEST(BadScene, NumbersThatAreNone) {
    TemporaryFolder const folder;
    for (float const bad : {NAN, INFINITY, 1e30f}) {
        GltfWriter writer;
        std::vector<float> positions = triangle_positions;
        positions[4] = bad;
        writer.array(positions, "VEC3");
        expect_error(folder.write("a.gltf", writer.json(one_mesh(R"("attributes":{"POSITION":0})"))),
                     "the position of vertex 1 is ");
    }
}

TEST(BadScene, WhatScalesTakeOutOfRangeStaysInIt) {
    TemporaryFolder const folder;
    Scene const scene = import_scene(
        folder.write("a.gltf", triangle_writer().json(triangle_mesh + R"("nodes":[{"scale":[1e8,1,1],"children":[1]},)"
                                                                      R"({"scale":[1e8,1,1],"mesh":0}])")));
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_EQ(scene.warnings[0], "node 1 is placed out of range; its transform is passed over");
    EXPECT_EQ(evaluate_pose(scene, {}, 0).world_from_node[1][0][0], 1e8f);
}

TEST(BadScene, BrokenNormalsAndCoordinatesAreRepairedWithAWarning) {
    GltfWriter writer = triangle_writer();
    writer.array(std::vector<float>{NAN, 0, 0, 0, 0, 0, 0, 0, 5}, "VEC3");
    writer.array(std::vector<float>{0, 0, NAN, 0, 1, 1}, "VEC2");
    TemporaryFolder const folder;
    Scene const scene = import_scene(
        folder.write("a.gltf", writer.json(one_mesh(R"("attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2})"))));
    EXPECT_EQ(scene.meshes[0].primitives[0].normals, std::vector<Vec3>(3, Vec3(0, 0, 1)));
    EXPECT_EQ(scene.meshes[0].primitives[0].uv[0][1], Vec2(0));
    EXPECT_EQ(scene.warnings.size(), 2u);
}

TEST(BadScene, RequiredExtensionsThatAreMissedAreNamed) {
    TemporaryFolder const folder;
    expect_error(folder.write("a.gltf", triangle_writer().json(one_mesh(R"("attributes":{"POSITION":5})",
                                                                        R"(,"extensionsRequired":["FANCY_a"])"))),
                 "it requires the extension FANCY_a, which is not read; mesh 0: accessor 5");
}

TEST(BadScene, SmallFilesThatGrowWithoutBound) {
    TemporaryFolder const folder;
    // A hundred thousand triangles of three vertices with two thousand morph targets, to be shaded flat.
    GltfWriter writer = triangle_writer();
    writer.array(std::vector<std::uint8_t>(300000, 1), "SCALAR", GltfWriter::u8);
    std::string targets = R"({"POSITION":0})";
    for (int i = 1; i < 2000; ++i) {
        targets += R"(,{"POSITION":0})";
    }
    expect_error(folder.write("a.glb", writer.glb(one_mesh(R"("attributes":{"POSITION":0},"indices":1,"targets":[)" +
                                                           targets + "]"))),
                 "--scene-memory");
}

/// Options with a small budget, so that a small file can ask for too much.
ImportOptions with_megabytes(std::uint64_t megabytes) {
    ImportOptions options;
    options.memory_bytes = megabytes << 20;
    return options;
}

/// Writes a triangle as .obj, whose material has these maps, lines of an .mtl. Returns the name of the file.
std::filesystem::path textured_triangle(TemporaryFolder const& folder, std::string const& maps) {
    folder.write("a.mtl", "newmtl m\n" + maps);
    return folder.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n");
}

TEST(BadScene, ZeroAccessorsAreCountedBeforeTheyAreMade) {
    TemporaryFolder const folder;
    GltfWriter writer = triangle_writer();
    std::string primitives;
    for (int i = 0; i < 20; ++i) {
        int const zeros = writer.accessor(R"("componentType":5126,"count":16777215,"type":"VEC3")");
        primitives += (i > 0 ? "," : "") + (R"({"attributes":{"POSITION":)" + std::to_string(zeros)) + "}}";
    }
    auto const file = folder.write(
        "a.gltf",
        writer.json(R"("nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}],"meshes":[{"primitives":[)" + primitives + "]}]"));
    expect_error(file, "more than 4096 MB");
    expect_error(file, "--scene-memory");
    expect_error(file, "more than 1 MB", with_megabytes(1));
}

TEST(BadScene, PicturesAreCountedBeforeTheyAreDecoded) {
    TemporaryFolder const folder;
    write_png(folder.path() / "large.png", Picture(600, 600)); // 1.4 MB of pixels
    std::string const text = triangle_writer().json(
        one_mesh(R"("attributes":{"POSITION":0},"material":0)",
                 R"(,"images":[{"uri":"large.png"},{"uri":"large.png"}],"textures":[{"source":0},{"source":1}],)"
                 R"("materials":[{"normalTexture":{"index":0},"emissiveTexture":{"index":1}}])"));
    auto const file = folder.write("a.gltf", text);
    EXPECT_EQ(import_scene(file, {}, with_megabytes(3)).images.size(), 2u);
    expect_error(file, "more than 2 MB", with_megabytes(2));
    expect_error(file, "more than 1 MB", with_megabytes(1));
    expect_error(textured_triangle(folder, "map_Kd large.png\n"), "more than 1 MB", with_megabytes(1));
}

TEST(BadScene, PicturesMadeOfTwoAreCounted) {
#ifdef FRAMELET_SANITIZE
    GTEST_SKIP() << "the sanitizer ends a program that is refused memory";
#endif
    TemporaryFolder const folder;
    write_png(folder.path() / "large.png", Picture(1200, 1200)); // 5.8 MB of pixels, and as much with another's alpha
    auto const file = textured_triangle(folder, "map_Kd large.png\nmap_d large.png\n");
    EXPECT_EQ(import_scene(file, {}, with_megabytes(20)).images.size(), 2u);
    expect_error(file, "more than 10 MB", with_megabytes(10));
}

TEST(BadScene, ObjectsAndListsOfJsonAreCounted) {
    TemporaryFolder const folder;
    auto const file_with = [&](std::string const& name, std::string const& element, std::string const& after) {
        std::string list = element;
        for (int i = 1; i < 30'000; ++i) {
            list += "," + element;
        }
        return folder.write("a.gltf", R"({"asset":{"version":"2.0"},")" + name + "\":[" + list + "]" + after + "}");
    };
    expect_error(file_with("materials", "{}", ""), "more than 16 MB", with_megabytes(16));
    expect_error(file_with("nodes", "{}", ""), "more than 16 MB", with_megabytes(16));
    expect_error(file_with(R"(skins":[{"joints)", "0", "}]"), "more than 1 MB", with_megabytes(1));
}

TEST(BadScene, CopiesOfWhatDeformsAreCounted) {
    TemporaryFolder const folder;
    // A thousand nodes that share ten thousand vertices with a morph target: 520 MB once each has moved its own.
    std::vector<float> positions;
    for (int i = 0; i < 10'000; ++i) {
        positions.insert(positions.end(), triangle_positions.begin(), triangle_positions.begin() + 3);
    }
    std::copy(triangle_positions.begin(), triangle_positions.end(), positions.begin());
    GltfWriter writer;
    writer.array(positions, "VEC3");
    writer.array(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    std::string nodes = R"({"mesh":0})";
    for (int i = 1; i < 1000; ++i) {
        nodes += R"(,{"mesh":0})";
    }
    auto const file_with = [&](std::string const& targets) {
        return folder.write("a.glb", writer.glb("\"nodes\":[" + nodes + R"(],"meshes":[{"primitives":[{"attributes":)" +
                                                R"({"POSITION":0,"NORMAL":0})" + targets + "}]}]"));
    };
    EXPECT_NO_THROW(import_scene(file_with(""), {}, with_megabytes(400)));
    expect_error(file_with(R"(,"targets":[{"POSITION":0}])"), "more than 400 MB", with_megabytes(400));
    EXPECT_NO_THROW(import_scene(file_with(R"(,"targets":[{"POSITION":0}])"), {}, with_megabytes(600)));
}

TEST(BadScene, CopiesOfAssimpMeshesAreCounted) {
    constexpr unsigned vertices = 10'000, nodes = 100;
    aiScene from; // owns all that is new here
    from.mMeshes = new aiMesh* [from.mNumMeshes = 1] { new aiMesh };
    from.mMeshes[0]->mVertices = new aiVector3D[from.mMeshes[0]->mNumVertices = vertices];
    from.mRootNode = new aiNode;
    for (unsigned n = 1; n <= nodes; ++n) { // the n-th lists the mesh n times: 5,050 copies
        auto* node = new aiNode;
        node->mMeshes = new unsigned[node->mNumMeshes = n]{};
        from.mRootNode->addChildren(1, &node);
    }
    Scene scene;
    ImportBudget budget(64 << 20);
    EXPECT_THROW(import_assimp_nodes(from, budget, scene), SceneTooLarge);
    EXPECT_LE(scene.meshes.size(), 20u);
}

TEST(BadScene, WeightsOfManyMorphTargetsAreCountedForEachNode) {
    TemporaryFolder const folder;
    std::string targets = "{}", nodes = R"({"mesh":0})";
    for (int i = 1; i < 10'000; ++i) {
        targets += ",{}";
        nodes += R"(,{"mesh":0})";
    }
    expect_error(folder.write("a.glb", triangle_writer().glb("\"nodes\":[" + nodes +
                                                             R"(],"meshes":[{"primitives":[{"attributes":)" +
                                                             R"({"POSITION":0},"targets":[)" + targets + "]}]}]")),
                 "more than 300 MB", with_megabytes(300));
}

TEST(BadScene, WarningsAreNotMoreThanSomebodyReads) {
    TemporaryFolder const folder;
    std::string meshes, nodes;
    for (int i = 0; i < 1000; ++i) {
        std::string const comma = i > 0 ? "," : "";
        meshes += comma + R"({"primitives":[{"attributes":{"POSITION":0}},{"attributes":{"POSITION":0},"mode":0}]})";
        nodes += comma + R"({"mesh":)" + std::to_string(i) + "}";
    }
    Scene const scene = import_scene(
        folder.write("a.glb", triangle_writer().glb("\"nodes\":[" + nodes + "],\"meshes\":[" + meshes + "]")));
    ASSERT_EQ(scene.warnings.size(), 101u);
    EXPECT_EQ(scene.warnings.back(), "900 more warnings");
}

TEST(BadScene, TheSceneFileItselfIsCounted) {
    TemporaryFolder const folder;
    std::string const text = triangle_writer().json(one_mesh(R"("attributes":{"POSITION":0})"));
    auto const file = folder.write("a.gltf", text + std::string(3 << 20, ' '));
    EXPECT_NO_THROW(import_scene(file, {}, with_megabytes(4)));
    expect_error(file, "more than 2 MB", with_megabytes(2));
}

TEST(BadScene, NamesAreOneLine) {
    TemporaryFolder const folder;
    std::string const text = triangle_writer().json(one_mesh(R"("attributes":{"POSITION":0})"));
    std::string named = text;
    named.replace(named.find("\"scenes\":[{"), 11, R"("scenes":[{"name":"a\nb\u001b[2J",)");
    Scene const scene = import_scene(folder.write("a.gltf", named));
    EXPECT_EQ(scene.name.find_first_of("\n\x1b"), std::string::npos) << scene.name;
}

/// Readers of such files take memory for the picture as they open them.
TEST(BadScene, HeadersOfLargePicturesTakeNoMemory) {
    TemporaryFolder const folder;
    std::string const animation("RIFF\0\1\0\0WEBPVP8X\x0a\0\0\0\2\0\0\0\xff\x3f\0\xff\x1f\0", 30); // 16384x8192
    folder.write("large.png", animation + std::string(200, '\0'));
    auto const file = textured_triangle(folder, "map_Kd large.png\n");
    expect_error(file, "more than 100 MB", with_megabytes(100));
}

/// Its coefficients are kept until the last part has come, in more memory than the picture takes.
TEST(BadScene, JpegsOfSeveralPartsTakeMoreThanThePicture) {
    TemporaryFolder const folder;
    auto const jpeg = [](char frame, char scan_components) { // 4096x4096 pixels of three components
        return std::string("\xff\xd8\xff", 3) + frame +
               std::string("\0\x11\x08\x10\0\x10\0\x03\1\x11\0\2\x11\0\3\x11\0\xff\xda\0\x0c", 21) + scan_components +
               std::string(200, '\0');
    };
    auto const file = textured_triangle(folder, "map_Kd a.jpg\n");
    folder.write("a.jpg", jpeg('\xc0', 3));
    EXPECT_NO_THROW(import_scene(file, {}, with_megabytes(100))) << "it is broken, but small enough";
    for (auto const& [frame, scan_components] : {std::pair('\xc2', 3), std::pair('\xc0', 1)}) {
        folder.write("a.jpg", jpeg(frame, static_cast<char>(scan_components)));
        expect_error(file, "more than 100 MB", with_megabytes(100));
        EXPECT_NO_THROW(import_scene(file, {}, with_megabytes(200)));
    }
}

/// A file takes as much memory to be read as it is long, whatever is in it; this one takes next to nothing of a disk.
TEST(BadScene, PictureFilesAreCountedBeforeTheyAreRead) {
    TemporaryFolder const folder;
    write_png(folder.path() / "long.png", Picture(4, 4));
    std::filesystem::resize_file(folder.path() / "long.png", 100 << 20);
    auto const file = textured_triangle(folder, "map_Kd long.png\n");
    EXPECT_EQ(import_scene(file, {}, with_megabytes(200)).images.size(), 1u);
    expect_error(file, "more than 90 MB", with_megabytes(90));
}

/// OpenImageIO would take memory for many rows, of a picture of bytes for 256, though there is one.
TEST(BadScene, WideFlatPicturesTakeLittleMemory) {
#ifdef FRAMELET_SANITIZE
    GTEST_SKIP() << "the sanitizer ends a program that is refused memory";
#endif
    TemporaryFolder const folder;
    auto const file = folder.path() / "wide.ppm";
    Picture wide(1'000'000, 1);
    std::ranges::fill(wide.rgba, std::uint8_t{255});
    write_ppm(file, wide);
    auto const sky = folder.write("wide.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1000000\n" +
                                                  std::string(4'000'000, '\x80'));
    // A BMP of 32 bits a pixel: 14 bytes, a header of 40, pixels.
    std::string bmp("BM\0\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\x40\x42\x0f\0\x01\0\0\0\x01\0\x20\0", 30);
    bmp.append(24, '\0').append(4 * 1'000'000, '\xff');
    auto const bitmap = folder.write("wide.bmp", bmp);
    MemoryLimit const limit(256 << 20);
    EXPECT_EQ(read_picture(file), wide);
    EXPECT_EQ(read_picture(bitmap), wide);
    EXPECT_EQ(read_float_image(sky).width, 1'000'000);
}

TEST(BadScene, OneBufferFileNamedOften) {
    TemporaryFolder const folder;
    folder.write("a.bin", std::string(1 << 20, '\0'));
    std::string const buffer = R"({"byteLength":1048576,"uri":"a.bin"})";
    std::string const text = R"({"asset":{"version":"2.0"},"buffers":[)" + buffer + "," + buffer + "," + buffer + "]}";
    expect_error(folder.write("a.gltf", text), "more than 2 MB", with_megabytes(2));
}

TEST(BadScene, MissingBufferViewsAreNamed) {
    TemporaryFolder const folder;
    auto const with_sparse = [&](std::string const& sparse) {
        GltfWriter writer = triangle_writer();
        int const view = writer.view(std::vector<float>{0, 3, 0});
        std::string text = sparse;
        text.replace(text.find('#'), 1, std::to_string(view));
        writer.accessor(R"("componentType":5126,"count":3,"type":"VEC3","sparse":)" + text);
        return folder.write("a.gltf", writer.json(one_mesh(R"("attributes":{"POSITION":1})")));
    };
    expect_error(with_sparse(R"({"count":1,"indices":{"componentType":5123},"values":{"bufferView":#}})"),
                 "accessor 1 is sparse, but its indices have no buffer view");
    expect_error(with_sparse(R"({"count":1,"values":{"bufferView":#}})"), "accessor 1 is sparse, but its indices");
    expect_error(with_sparse(R"({"count":1,"indices":{"componentType":5123,"bufferView":#},"values":{}})"),
                 "accessor 1 is sparse, but its values");
    GltfWriter writer = triangle_writer();
    writer.accessor(R"("componentType":5123,"count":3,"type":"SCALAR")");
    std::string const primitive = R"("attributes":{"POSITION":0},"indices":1)";
    expect_error(folder.write("b.gltf", writer.json(one_mesh(primitive))),
                 "accessor 1 holds vertex indices, but has no buffer view");
}

/// A small file with most of what the importer knows, as binary glTF.
std::string rich_glb() {
    GltfWriter writer = triangle_writer();
    writer.array(std::vector<std::uint16_t>{0, 1, 2}, "SCALAR", GltfWriter::u16);
    writer.array(std::vector<std::uint8_t>{0, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0}, "VEC4", GltfWriter::u8);
    writer.array(std::vector<float>{0.5f, 0.5f, 0, 0, 1, 0, 0, 0, 0.3f, 0.3f, 0, 0}, "VEC4");
    writer.array(std::vector<float>{0, 1}, "SCALAR");
    writer.array(std::vector<float>{0, 0, 0, 1, 0, 1, 0, 0}, "VEC4");
    writer.array(std::vector<float>{0, 0, 1, 1, 0, 1}, "VEC2");
    writer.array(std::vector<float>(32, 0.5f), "MAT4");
    int const indices = writer.view(std::vector<std::uint16_t>{2});
    int const values = writer.view(std::vector<float>{0, 3, 0});
    int const image = writer.view(std::vector<std::uint8_t>{'n', 'o', ' ', 'p', 'i', 'c', 't', 'u', 'r', 'e', '!', 0});
    writer.accessor(R"("componentType":5126,"count":3,"type":"VEC3","sparse":{"count":1,"indices":{"bufferView":)" +
                    std::to_string(indices) + R"(,"componentType":5123},"values":{"bufferView":)" +
                    std::to_string(values) + "}}");
    return writer.glb(
        R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"skin":0,"children":[1]},{"rotation":[0,0,0,1],)"
        R"("children":[2]},{"camera":0,"translation":[1,2,3],"extensions":{"KHR_lights_punctual":{"light":0}}}],)"
        R"("cameras":[{"type":"perspective","perspective":{"yfov":0.8,"znear":0.1}}],)"
        R"("extensions":{"KHR_lights_punctual":{"lights":[{"type":"point"}]}},)"
        R"("skins":[{"joints":[1,2],"inverseBindMatrices":7}],"images":[{"bufferView":)" +
        std::to_string(image) +
        R"(,"mimeType":"image/png"}],"textures":[{"source":0}],"materials":[{"normalTexture":{"index":0}}],)"
        R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":2,"WEIGHTS_0":3,"TEXCOORD_0":6},"indices":1,)"
        R"("material":0,"targets":[{"POSITION":8}]}]}],"animations":[{"samplers":[{"input":4,"output":5}],)"
        R"("channels":[{"sampler":0,"target":{"node":1,"path":"rotation"}}]}])");
}

bool all_finite(std::vector<Vec3> const& vectors) {
    for (Vec3 const& v : vectors) {
        if (!std::isfinite(v.x + v.y + v.z)) {
            return false;
        }
    }
    return true;
}

TEST(BadScene, FlippedBytesGiveASceneOrAnError) {
    TemporaryFolder const folder;
    std::string const whole = rich_glb();
    ASSERT_NO_THROW(import_scene(folder.write("a.glb", whole)));
    std::mt19937 random(7);
    int scenes = 0;
    int errors = 0;
    for (int round = 0; round < 4000; ++round) {
        std::string bytes = whole;
        int const flips = 1 + static_cast<int>(random() % 3);
        for (int i = 0; i < flips; ++i) {
            char& byte = bytes[random() % bytes.size()];
            // The byte is a digit half of the time, so that the JSON stays whole and its numbers go wrong.
            byte = random() % 2 ? static_cast<char>('0' + random() % 10) : static_cast<char>(random());
        }
        try {
            Scene const scene = import_scene(folder.write("b.glb", bytes));
            ScenePose const pose = evaluate_pose(scene, default_clips(scene), 0.3);
            DeformedVertices deformed;
            for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
                Node const& node = scene.nodes[n];
                if (node.mesh != none) {
                    for (Primitive const& primitive : scene.meshes[static_cast<std::size_t>(node.mesh)].primitives) {
                        deform(primitive, pose.morph_weights[n],
                               node.skin == none ? nullptr : &scene.skins[static_cast<std::size_t>(node.skin)], pose,
                               deformed);
                        ASSERT_TRUE(all_finite(deformed.positions) && all_finite(deformed.normals))
                            << "round " << round;
                    }
                }
            }
            ++scenes;
        } catch (InputError const& error) {
            ASSERT_EQ(std::string(error.what()).find('\n'), std::string::npos) << "round " << round;
            ++errors;
        }
    }
    EXPECT_GT(scenes, 500);
    EXPECT_GT(errors, 500);
}

} // namespace
} // namespace framelet
