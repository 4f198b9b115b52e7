#include "server/scene/reading/scene_folder.h"

#include <thread>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "common/error.h"
#include "common/files/picture_writer.h"
#include "gltf_writer.h"
#include "server/scene/scene_import.h"

namespace framelet {
namespace {

namespace fs = std::filesystem;

/// A scene's folder beside a picture, a buffer and a material file that are none of its business.
class Outside : public testing::Test {
protected:
    Outside() {
        fs::create_directory(scenes);
        fs::create_directory(outer.path() / "scenes2");
        Picture picture(2, 2);
        picture.rgba.assign(16, 255);
        write_png(outer.path() / "secret.png", picture);
        write_png(outer.path() / "scenes2" / "secret.png", picture);
        write_png(scenes / "own.png", picture);
        fs::create_symlink("../secret.png", scenes / "link.png");
        fs::create_directory_symlink("..", scenes / "up");
        outer.write("secret.bin", std::string(36, '\1'));
        outer.write("secret.mtl", "newmtl m\nKd 1 0 0\n");
    }

    std::string textured_gltf(std::string const& uri) const {
        GltfWriter writer;
        writer.array(triangle_positions, "VEC3");
        return writer.json(one_mesh(R"("attributes":{"POSITION":0},"material":0)",
                                    R"(,"images":[{"uri":")" + uri + R"("}],"textures":[{"source":0}],"materials":)" +
                                        R"([{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])"));
    }

    Scene import(std::string const& name, std::string const& text, bool allow_outside = false) const {
        ImportOptions options;
        options.allow_outside = allow_outside;
        return import_scene(outer.write("scenes/" + name, text), {}, options);
    }

    std::vector<std::string> const ways_out{"../secret.png",         "..%2fsecret.png", "%2e%2e%2Fsecret.png",
                                            "../scenes2/secret.png", "link.png",        "up/secret.png",
                                            "up/../secret.png",      "../missing.png",  "sub/../../secret.png"};

    TemporaryFolder outer;
    fs::path scenes = outer.path() / "scenes";
};

std::string joined(std::vector<std::string> const& lines) {
    std::string text;
    for (std::string const& line : lines) {
        text += line + "\n";
    }
    return text;
}

TEST_F(Outside, PicturesOfAGltfAreRefusedWithALine) {
    for (std::string const& uri : ways_out) {
        Scene const scene = import("a.gltf", textured_gltf(uri));
        EXPECT_TRUE(scene.images.empty()) << uri;
        ASSERT_EQ(scene.warnings.size(), 1u) << uri << joined(scene.warnings);
        EXPECT_NE(scene.warnings[0].find("outside the scene's folder"), std::string::npos) << scene.warnings[0];
        EXPECT_NE(scene.warnings[0].find(".png"), std::string::npos) << scene.warnings[0];
    }
}

TEST_F(Outside, WhatLiesInTheFolderIsRead) {
    for (std::string const uri : {"own.png", "./own.png", "../scenes/own.png", "up/scenes/own.png"}) {
        Scene const scene = import("a.gltf", textured_gltf(uri));
        EXPECT_EQ(scene.images.size(), 1u) << uri << joined(scene.warnings);
    }
    Scene const gone = import("a.gltf", textured_gltf("gone.png"));
    EXPECT_NE(joined(gone.warnings).find("'gone.png' is missing"), std::string::npos) << joined(gone.warnings);
}

TEST_F(Outside, AllowOutsideReadsThem) {
    for (std::string const uri : {"../secret.png", "..%2fsecret.png", "link.png", "up/secret.png"}) {
        EXPECT_EQ(import("a.gltf", textured_gltf(uri), true).images.size(), 1u) << uri;
    }
}

TEST_F(Outside, BuffersOfAGltfAreErrors) {
    GltfWriter writer;
    writer.array(triangle_positions, "VEC3");
    std::string text = writer.json(one_mesh(R"("attributes":{"POSITION":0})"), false);
    text.replace(text.find(R"("byteLength":36)"), 15, R"("byteLength":36,"uri":"..%2Fsecret.bin")");
    try {
        import("a.gltf", text);
        ADD_FAILURE() << "loaded";
    } catch (InputError const& error) {
        std::string const line = error.what();
        EXPECT_NE(line.find("outside the scene's folder"), std::string::npos) << line;
        EXPECT_NE(line.find("secret.bin"), std::string::npos) << line;
        EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    }
    EXPECT_NO_THROW(import("a.gltf", text, true));
}

TEST_F(Outside, MaterialFilesAndPicturesOfAnObj) {
    std::string const triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n";
    auto const has_red = [](Scene const& scene) {
        for (Material const& material : scene.materials) {
            if (material.base_color.x == 1 && material.base_color.y == 0) {
                return true;
            }
        }
        return false;
    };
    Scene const refused = import("a.obj", "mtllib ../secret.mtl\n" + triangle);
    EXPECT_FALSE(has_red(refused));
    ASSERT_EQ(refused.warnings.size(), 1u) << joined(refused.warnings);
    EXPECT_NE(refused.warnings[0].find("secret.mtl"), std::string::npos) << refused.warnings[0];
    EXPECT_NE(refused.warnings[0].find("outside"), std::string::npos) << refused.warnings[0];
    EXPECT_TRUE(has_red(import("a.obj", "mtllib ../secret.mtl\n" + triangle, true)));

    for (std::string const name : {"../secret.png", "..\\secret.png", "link.png", "up/secret.png"}) {
        outer.write("scenes/b.mtl", "newmtl m\nmap_Kd " + name + "\n");
        Scene const scene = import("b.obj", "mtllib b.mtl\n" + triangle);
        EXPECT_TRUE(scene.images.empty()) << name;
        ASSERT_EQ(scene.warnings.size(), 1u) << name << joined(scene.warnings);
        EXPECT_NE(scene.warnings[0].find("outside"), std::string::npos) << scene.warnings[0];
        EXPECT_EQ(import("b.obj", "mtllib b.mtl\n" + triangle, true).images.size(), 1u) << name;
    }
}

/// As whoever may write there can do between a look at a file and its reading.
TEST_F(Outside, AFileThatBecomesALinkIsNotReadWhereThatLeads) {
    outer.write("scenes/b.mtl", "newmtl m\nmap_Kd own.png\n");
    for (fs::path const& file :
         {outer.write("scenes/b.obj", "mtllib b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n"),
          outer.write("scenes/b.gltf", textured_gltf("own.png"))}) {
        auto const swap = [this](std::string_view what, double) {
            if (what == "images" && !fs::is_symlink(scenes / "own.png")) { // they have been found by then
                fs::rename(scenes / "own.png", scenes / "kept.png");
                fs::create_symlink("../secret.png", scenes / "own.png");
            }
        };
        Scene const scene = import_scene(file, swap, {});
        EXPECT_TRUE(scene.images.empty()) << file;
        EXPECT_NE(joined(scene.warnings).find("own.png': the file cannot be read"), std::string::npos)
            << file << joined(scene.warnings);
        fs::rename(scenes / "kept.png", scenes / "own.png");
    }
}

/// A buffer is read right after it is found: what is changed all the time is now and then changed between the two.
TEST_F(Outside, ABufferThatBecomesALinkIsNotReadWhereThatLeads) {
    fs::path const own = scenes / "own.bin", kept = scenes / "kept.bin", next = scenes / "next.bin";
    std::string corners(reinterpret_cast<char const*>(triangle_positions.data()), 36);
    outer.write("scenes/kept.bin", corners);
    fs::copy_file(kept, own);
    corners[3] = 0x40; // makes the first number 2
    outer.write("secret.bin", corners);
    GltfWriter writer;
    writer.array(triangle_positions, "VEC3");
    std::string text = writer.json(one_mesh(R"("attributes":{"POSITION":0})"), false);
    text.replace(text.find(R"("byteLength":36)"), 15, R"("byteLength":36,"uri":"own.bin")");
    fs::path const file = outer.write("scenes/a.gltf", text);
    std::jthread const swapper([&](std::stop_token const& stop) {
        while (!stop.stop_requested()) {
            fs::create_hard_link(kept, next);
            fs::rename(next, own);
            fs::create_symlink("../secret.bin", next);
            fs::rename(next, own);
        }
    });
    int read = 0, refused = 0;
    while (read < 500 || refused < 500) {
        try {
            Scene const scene = import_scene(file);
            ++read;
            ASSERT_EQ(scene.meshes[0].primitives[0].positions[0].x, 0) << "after " << read << " files and " << refused;
        } catch (InputError const&) {
            ++refused;
        }
    }
}

TEST_F(Outside, WhatIsOpenedIsJudged) {
    SceneFolder const folder(scenes / "a.gltf", false), any(scenes / "a.gltf", true);
    fs::path const own = scenes / "own.png", link = scenes / "link.png", pipe = scenes / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    ASSERT_TRUE(folder.permits(own) && folder.open(own));
    EXPECT_EQ(folder.open(own)->canonical(), fs::canonical(own));
    fs::create_symlink(fs::absolute(own), scenes / "own link.png");
    EXPECT_TRUE(folder.open(scenes / "own link.png"));
    EXPECT_FALSE(folder.open(link));
    EXPECT_TRUE(any.open(link));
    fs::remove(own);
    fs::create_symlink("../secret.png", own);
    EXPECT_FALSE(folder.open(own)) << "which was permitted";
    EXPECT_FALSE(any.open(pipe));
    EXPECT_FALSE(any.open(scenes));
    EXPECT_FALSE(any.open(scenes / "missing"));
}

TEST_F(Outside, TheSceneFileItselfMayBeALink) {
    outer.write("real.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    outer.write("real.gltf", textured_gltf("own.png"));
    fs::create_symlink("../real.obj", scenes / "linked.obj");
    fs::create_symlink("../real.gltf", scenes / "linked.gltf");
    EXPECT_EQ(import_scene(scenes / "linked.obj").meshes.size(), 1u);
    EXPECT_EQ(import_scene(scenes / "linked.gltf").images.size(), 1u);
}

} // namespace
} // namespace framelet
