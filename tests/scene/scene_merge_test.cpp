// Tests what several scene files are together, and the list of those in a folder.
#include "server/scene/scene_merge.h"

#include <gtest/gtest.h>

#include "common/error.h"
#include "gltf_writer.h"
#include "server/scene/motion/animation.h"
#include "server/scene/scene_import.h"
#include "server/scene/scene_list.h"
#include "server/scene/summary/scene_summary.h"

namespace framelet {
namespace {

namespace fs = std::filesystem;

/// One of everything, with each index 0 or 1.
Scene one_of_everything(std::string const& file) {
    Scene scene;
    scene.images = {std::make_shared<Picture const>(), std::make_shared<Picture const>()};
    scene.textures = {{.image = 1}};
    Material material;
    material.name = "paint";
    material.base_color_texture.texture = 0;
    material.emissive_texture.texture = 0;
    scene.materials = {material};
    Primitive primitive;
    primitive.positions.assign(3, Vec3(0));
    primitive.triangles = {{0, 1, 2}};
    scene.meshes = {{"body", {primitive}, {}}};
    scene.nodes.resize(2);
    scene.nodes[0].name = "root of " + file;
    scene.nodes[1].name = "wheel";
    scene.nodes[1].parent = 0;
    scene.nodes[1].mesh = 0;
    scene.nodes[1].skin = 0;
    scene.skins = {{{1, 0}, {Mat4(1), Mat4(1)}}};
    scene.clips = {{"turn", 2, {{.node = 1, .times = {0, 2}, .values = {0, 0, 0, 4, 0, 0}}}}};
    scene.lights = {{.name = "lamp", .node = 1}};
    scene.cameras = {{.name = "driver", .node = 1}};
    scene.warnings = {"something"};
    scene.files = {"/" + file + ".glb", "/" + file + ".png"};
    return scene;
}

TEST(SceneMerge, ScenesThatAgreeOnTheirLightKeepIt) {
    std::vector<std::string> const words{"car", "bus"};
    Scene car = one_of_everything("car"), bus = one_of_everything("bus");
    car.light = "direct";
    EXPECT_EQ(merged_scene({car, bus}, words).light, "");
    bus.light = "direct";
    EXPECT_EQ(merged_scene({car, bus}, words).light, "direct");
}

TEST(SceneMerge, EveryIndexIsOfItsOwnScene) {
    std::vector<std::string> const words{"car", "bus", "tram"};
    Scene const scene =
        merged_scene({one_of_everything("car"), one_of_everything("bus"), one_of_everything("tram")}, words);
    EXPECT_EQ(scene.name, "car + bus + tram");
    EXPECT_EQ(scene.images.size(), 6u);
    for (std::size_t s = 0; s < 3; ++s) {
        Index const at = static_cast<Index>(s);
        EXPECT_EQ(scene.textures.at(s).image, 2 * at + 1);
        Material const& material = scene.materials.at(s);
        EXPECT_EQ(material.base_color_texture.texture, at);
        EXPECT_EQ(material.emissive_texture.texture, at);
        EXPECT_EQ(material.normal_texture.texture, none);
        EXPECT_EQ(scene.meshes.at(s).primitives.at(0).material, at);
        Node const& root = scene.nodes.at(2 * s);
        EXPECT_EQ(root.parent, none);
        EXPECT_EQ(root.mesh, none);
        Node const& wheel = scene.nodes.at(2 * s + 1);
        EXPECT_EQ(wheel.parent, 2 * at);
        EXPECT_EQ(wheel.mesh, at);
        EXPECT_EQ(wheel.skin, at);
        EXPECT_EQ(scene.skins.at(s).joints, (std::vector<Index>{2 * at + 1, 2 * at}));
        EXPECT_EQ(scene.clips.at(s).channels.at(0).node, 2 * at + 1);
        EXPECT_EQ(scene.lights.at(s).node, 2 * at + 1);
        EXPECT_EQ(scene.cameras.at(s).node, 2 * at + 1);
        EXPECT_EQ(scene.warnings.at(s), words[s] + ": something");
        EXPECT_EQ(scene.files.at(s), "/" + words[s] + ".glb");
        EXPECT_EQ(scene.files.at(3 + s), "/" + words[s] + ".png");
    }
    EXPECT_EQ(scene.scene_files, 3u);
}

TEST(SceneMerge, NamesThatClashGetTheWordOfTheirScene) {
    std::vector<std::string> const words{"car", "bus"};
    Scene const scene = merged_scene({one_of_everything("car"), one_of_everything("bus")}, words);
    EXPECT_EQ(scene.nodes[0].name, "root of car") << "there is one of it";
    EXPECT_EQ(scene.nodes[1].name, "car/wheel");
    EXPECT_EQ(scene.nodes[3].name, "bus/wheel");
    EXPECT_EQ(scene.meshes[1].name, "bus/body");
    EXPECT_EQ(scene.materials[1].name, "bus/paint");
    EXPECT_EQ(scene.clips[1].name, "bus/turn");
    EXPECT_EQ(scene.lights[1].name, "bus/lamp");
    EXPECT_EQ(scene.cameras[0].name, "car/driver");
    EXPECT_EQ(clips_named(scene, std::vector<std::string>{"bus/turn"}), std::vector<Index>{1});
}

TEST(SceneMerge, WordsAreNamesOfFilesAndDiffer) {
    std::vector<fs::path> const files{"a/house.glb", "b/house.obj", "car.tar.gltf", "house-2.glb"};
    EXPECT_EQ(words_for(files), (std::vector<std::string>{"house", "house-2", "car.tar", "house-2-2"}));
    std::vector<std::string> const words{"a", "b", "c", "d"};
    EXPECT_EQ(merged_scene(std::vector<Scene>(4), words).name, "a + b + 2 more");
}

/// A file with a triangle that moves by `x` in a second, on a node that stands at height `y`.
std::string moving_triangle(float x, float y, std::string const& color) {
    GltfWriter writer;
    writer.array(triangle_positions, "VEC3");
    writer.array(std::vector<float>{0, 1}, "SCALAR");
    writer.array(std::vector<float>{0, 0, 0, x, 0, 0}, "VEC3");
    return writer.json(
        R"("scene":0,"scenes":[{"name":"Scene","nodes":[0]}],"nodes":[{"name":"stand","translation":[0,)" +
        std::to_string(y) +
        R"(,0],"children":[1]},{"name":"mover","mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},)"
        R"("material":1}]}],"materials":[{},{"name":"paint","pbrMetallicRoughness":{"baseColorFactor":)" +
        color +
        R"(}}],"animations":[{"name":"go","samplers":[{"input":1,"output":2}],"channels":[{"sampler":0,"target":)"
        R"({"node":1,"path":"translation"}}]}])");
}

TEST(SceneMerge, BothFilesAreThereAndMove) {
    TemporaryFolder const folder;
    std::vector<fs::path> const files{folder.write("red.gltf", moving_triangle(2, 3, "[1,0,0,1]")),
                                      folder.write("green.gltf", moving_triangle(-4, 5, "[0,1,0,1]"))};
    std::vector<std::string> told;
    Scene const scene = import_scenes(files, [&](std::string_view what, double) { told.emplace_back(what); });
    EXPECT_EQ(scene.name, "red + green");
    EXPECT_EQ(scene.nodes.size(), 4u);
    EXPECT_EQ(scene.materials.size(), 4u);
    EXPECT_EQ(count_triangles(scene), 2u);
    EXPECT_EQ(scene.scene_files, 2u);
    EXPECT_EQ(scene.files, (std::vector<fs::path>{files[0], files[1]}));
    EXPECT_EQ(told.front(), "reading (red.gltf)");
    EXPECT_EQ(told.back(), "meshes (green.gltf)");
    std::vector<Index> const clips = default_clips(scene);
    EXPECT_EQ(clips, (std::vector<Index>{0, 1})) << "they move different things";
    ScenePose const pose = evaluate_pose(scene, clips, 0.5);
    std::vector<Vec3> places;
    std::vector<Vec4> colors;
    for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
        if (scene.nodes[n].mesh != none) {
            Mesh const& mesh = scene.meshes.at(static_cast<std::size_t>(scene.nodes[n].mesh));
            places.emplace_back(pose.world_from_node[n][3]);
            colors.push_back(scene.materials.at(static_cast<std::size_t>(mesh.primitives.at(0).material)).base_color);
        }
    }
    EXPECT_EQ(places, (std::vector<Vec3>{{1, 3, 0}, {-2, 5, 0}}));
    EXPECT_EQ(colors, (std::vector<Vec4>{{1, 0, 0, 1}, {0, 1, 0, 1}}));
}

/// The complaint about these files; empty where they are loaded.
std::string complaint(std::vector<fs::path> const& files, ImportOptions const& options = {}) {
    try {
        import_scenes(files, {}, options);
        return "";
    } catch (InputError const& error) {
        return error.what();
    }
}

TEST(SceneMerge, ErrorsNameTheFileThatIsWrong) {
    TemporaryFolder const folder;
    fs::path const good = folder.write("good.gltf", moving_triangle(1, 1, "[1,1,1,1]"));
    for (fs::path const& wrong :
         {folder.write("wrong.gltf", "nonsense"), folder.path() / "absent.glb", folder.path()}) {
        for (auto const& files : {std::vector{good, wrong}, std::vector{wrong, good}, std::vector{good, good, wrong}}) {
            EXPECT_TRUE(complaint(files).starts_with("cannot load scene '" + wrong.string() + "': "))
                << complaint(files);
        }
    }
    EXPECT_EQ(complaint({good, good}), "") << "twice the same is no mistake";
}

TEST(SceneMerge, AllFilesTogetherHaveTheMemory) {
    TemporaryFolder const folder;
    GltfWriter writer;
    writer.array(std::vector<float>(90'000, 1.0f), "VEC3");
    fs::path const file = folder.write("a.glb", writer.glb(one_mesh(R"("attributes":{"POSITION":0})")));
    fs::path const other = folder.write("b.glb", writer.glb(one_mesh(R"("attributes":{"POSITION":0})")));
    ImportOptions options;
    options.memory_bytes = 0;
    do {
        options.memory_bytes += 100'000;
        ASSERT_LT(options.memory_bytes, 100'000'000u);
    } while (!complaint({file}, options).empty());
    EXPECT_NE(complaint({file, other}, options).find("b.glb': it takes more than"), std::string::npos);
    options.memory_bytes *= 2;
    EXPECT_EQ(complaint({file, other}, options), "");
}

TEST(SceneMerge, EachFileReadsFromItsOwnFolder) {
    TemporaryFolder const one, other;
    GltfWriter writer;
    writer.array(triangle_positions, "VEC3");
    std::string json = writer.json(one_mesh(R"("attributes":{"POSITION":0})"), false);
    std::string const length = R"("byteLength":36)";
    json.replace(json.find(length), length.size(), length + R"(,"uri":"a.bin")");
    std::string const bytes(reinterpret_cast<char const*>(triangle_positions.data()), 36);
    one.write("a.bin", bytes);
    std::vector<fs::path> const files{one.write("a.gltf", json), other.write("b.gltf", json)};
    EXPECT_NE(complaint(files).find("b.gltf"), std::string::npos) << "the buffer is in the other one's folder";
    other.write("a.bin", bytes);
    EXPECT_EQ(complaint(files), "");
    EXPECT_EQ(import_scenes(files).files,
              (std::vector<fs::path>{files[0], files[1], one.path() / "a.bin", other.path() / "a.bin"}));
}

TEST(SceneList, HasTheFilesThatAreRead) {
    TemporaryFolder const folder;
    for (char const* const name : {"b.glb", "a.gltf", "Car.OBJ", "notes.txt", "paint.mtl", "picture.png", "data.bin"}) {
        folder.write(name, "");
    }
    fs::create_directories(folder.path() / "below.glb");
    folder.write("below.glb/c.glb", "");
    fs::create_directories(folder.path() / "B" / "deep");
    folder.write("B/deep/d.glb", "");
    fs::create_directories(folder.path() / ".hidden");
    folder.write(".hidden/e.glb", "");
    fs::create_directory_symlink(folder.path(), folder.path() / "B" / "loop");
    fs::create_symlink(folder.path() / "b.glb", folder.path() / "link.glb");
    fs::create_symlink(folder.path() / "nowhere", folder.path() / "broken.glb");
    std::vector<std::string> names;
    for (fs::path const& file : scene_files_in(folder.path())) {
        names.push_back(file.lexically_relative(folder.path()));
    }
    EXPECT_EQ(names,
              (std::vector<std::string>{"B/deep/d.glb", "Car.OBJ", "a.gltf", "b.glb", "below.glb/c.glb", "link.glb"}));
    EXPECT_THROW(scene_files_in(folder.path() / "absent"), InputError);
}

} // namespace
} // namespace framelet
