#include "server/scene/reading/named_file.h"

#include <gtest/gtest.h>

#include "common/files/picture_writer.h"
#include "gltf_writer.h"
#include "server/scene/scene_import.h"

namespace framelet {
namespace {

namespace fs = std::filesystem;

struct NamedFiles : testing::Test {
    NamedFiles() {
        fs::create_directories(folder.path() / "scene" / "textures");
        for (char const* const name : {"scene/textures/red.png", "scene/Straße.png", "scene/caf\xc3\xa9.png",
                                       "scene/two words.png", "outside.png"}) {
            Picture picture(2, 2);
            picture.rgba.assign(16, 255);
            write_png(folder.path() / name, picture);
        }
    }
    std::string found(std::string const& name) const {
        SceneFolder const scene(folder.path() / "scene" / "a.obj", false);
        NamedFile const file = find_named_file(scene, "image", name);
        EXPECT_EQ(file.remark.empty(), file.file.empty() || file.file == scene.path() / name) << file.remark;
        return file.file.empty() ? "" : file.file.lexically_relative(scene.path()).string();
    }

    TemporaryFolder folder;
};

TEST_F(NamedFiles, AreFoundByOneRule) {
    for (std::string const name :
         {"textures/red.png", "textures\\red.png", ".\\textures\\red.png", "  textures/red.png \r",
          "\"textures/red.png\"", "'textures\\red.png'", "C:\\work\\car\\textures\\red.png",
          "/home/somebody/textures/red.png", "../textures/red.png", "Textures/RED.PNG", "D:\\CAR\\TEXTURES\\RED.png",
          "Textures/./red.png"}) {
        EXPECT_EQ(found(name), "textures/red.png") << name;
    }
    EXPECT_EQ(found("two words.png"), "two words.png");
    EXPECT_EQ(found("TWO WORDS.PNG"), "two words.png");
    EXPECT_EQ(found("STRASSE.png"), "Straße.png");
    EXPECT_EQ(found("cafe\xcc\x81.png"), "caf\xc3\xa9.png") << "composed otherwise";
    EXPECT_EQ(found("lost/two words.png"), "two words.png") << "by its last part";
}

TEST_F(NamedFiles, NeverLieOutside) {
    for (std::string const name : {"../outside.png", "..\\outside.png", "OUTSIDE.PNG", "../OUTSIDE.png", "outside.png",
                                   "", ".", "..", "textures", "/", "\\", "\"\"", "gone.png"}) {
        EXPECT_EQ(found(name), "") << name;
    }
    fs::create_symlink("../outside.png", folder.path() / "scene" / "link.png");
    EXPECT_EQ(found("LINK.png"), "");
    EXPECT_EQ(found("link.png"), "");
}

TEST_F(NamedFiles, OfAllFormats) {
    GltfWriter writer;
    writer.array(triangle_positions, "VEC3");
    for (std::string const uri : {"textures\\\\red.png", "textures%5Cred.png", "C:\\\\car\\\\Textures\\\\red.png"}) {
        Scene const scene = import_scene(
            folder.write("scene/a.gltf",
                         writer.json(one_mesh(R"("attributes":{"POSITION":0},"material":0)",
                                              R"(,"images":[{"uri":")" + uri +
                                                  R"("}],"textures":[{"source":0}],"materials":)"
                                                  R"([{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])"))));
        EXPECT_EQ(scene.images.size(), 1u) << uri;
        ASSERT_EQ(scene.warnings.size(), 1u) << uri;
        EXPECT_NE(scene.warnings[0].find("'textures/red.png' is taken"), std::string::npos) << scene.warnings[0];
    }
    folder.write("scene/Paint.MTL", "newmtl m\nmap_Kd C:\\car\\textures\\RED.png\n");
    Scene const obj = import_scene(folder.write(
        "scene/a.obj", "mtllib \"paint.mtl\"\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n"));
    EXPECT_EQ(obj.images.size(), 1u);
    EXPECT_EQ(obj.warnings.size(), 2u);
}

} // namespace
} // namespace framelet
