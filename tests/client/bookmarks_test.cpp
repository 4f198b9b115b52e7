#include "client/window/kept/bookmarks.h"

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "client/core/camera/camera_path.h"
#include "client/core/camera/camera_text.h"
#include "client/window/kept/user_files.h"
#include "common/error.h"
#include "tests/client/own_folder.h"

namespace framelet {
namespace {

Camera some_camera() {
    return look_at({9.1f, 4, 12}, {0, 1, 0.3f}, {0, 1, 0}, 0.7f);
}

void expect_near(Camera const& a, Camera const& b) {
    EXPECT_LT(glm::distance(a.position, b.position), 1e-5f);
    EXPECT_LT(glm::distance(a.forward(), b.forward()), 1e-5f);
    EXPECT_LT(glm::distance(a.up(), b.up()), 1e-5f);
    EXPECT_EQ(a.projection, b.projection);
    EXPECT_NEAR(a.vertical_extent, b.vertical_extent, 1e-5f);
}

TEST(CameraFile, IsReadByThePrograms) {
    Camera camera = some_camera();
    camera.orientation = glm::normalize(camera.orientation * Quat(0.9f, 0, 0, 0.3f)); // rolled
    CameraPath const path = parse_camera_path(camera_file_text(camera, {}), "test");
    ASSERT_EQ(path.keys.size(), 1u);
    expect_near(path.at(0), camera);
    EXPECT_EQ(path.moment, CameraMoment());
    camera.projection = Projection::orthographic;
    camera.vertical_extent = 12.5f;
    CameraMoment const moment{12.25, true, -0.75f};
    CameraPath const flat = parse_camera_path(camera_file_text(camera, moment), "test");
    expect_near(flat.at(0), camera);
    EXPECT_EQ(flat.moment, moment);
}

TEST(CameraFile, IsFoundInAnAddress) {
    EXPECT_EQ(camera_in_address("http://localhost:7070/#token=a&camera=%7B%22x%22%3A+1%7D&b"), "{\"x\":+1}");
    EXPECT_EQ(camera_in_address("http://localhost/?camera=no#camera=%7b%zz%"), "{%zz%");
    EXPECT_FALSE(camera_in_address("camera=of/a/file"));
    EXPECT_FALSE(camera_in_address("http://localhost/#token=camera=3"));
    std::string address = "https://there/#camera=";
    for (char const c : camera_file_text(some_camera(), {})) {
        address += c == '"' ? "%22" : std::string(1, c);
    }
    expect_near(read_camera_path(address).at(0), some_camera());
}

TEST(Bookmarks, SurviveARestart) {
    OwnFolder const folder;
    auto const file = folder.path() / "deep" / "scene.json";
    {
        Bookmarks bookmarks(file);
        EXPECT_TRUE(bookmarks.all().empty());
        EXPECT_EQ(bookmarks.complaint(), "");
        bookmarks.add(some_camera());
        Camera flat = some_camera();
        flat.projection = Projection::orthographic;
        flat.vertical_extent = 12.5f;
        bookmarks.add(flat);
        bookmarks.rename(0, "from the \"roof\" \xc3\xa4");
    }
    Bookmarks again(file);
    EXPECT_EQ(again.complaint(), "");
    ASSERT_EQ(again.all().size(), 2u);
    EXPECT_EQ(again.all()[0].name, "from the \"roof\" \xc3\xa4");
    EXPECT_EQ(again.all()[1].name, "view 2");
    expect_near(again.all()[0].camera, some_camera());
    EXPECT_EQ(again.all()[1].camera.projection, Projection::orthographic);
    EXPECT_EQ(again.all()[1].camera.vertical_extent, 12.5f);
    again.remove(0);
    again.remove(7); // there is none
    EXPECT_EQ(Bookmarks(file).all().size(), 1u);
}

TEST(Bookmarks, KeepPlacesAsTheSceneFileCounts) {
    OwnFolder const folder;
    glm::dvec3 const origin(1842016, 0, -5173312);
    Bookmarks(folder.path() / "a.json", {}, origin).add(some_camera());
    Bookmarks(folder.path() / "b.json").add(some_camera());
    expect_near(Bookmarks(folder.path() / "a.json", {}, origin).all().at(0).camera, some_camera());
    Bookmarks const moved(folder.path() / "a.json", {}, origin + glm::dvec3(1, 0, 0)); // by a change of the scene
    EXPECT_LT(glm::distance(moved.all().at(0).camera.position, some_camera().position - Vec3(1, 0, 0)), 1e-5f);
    CameraPath const copied = parse_camera_path(camera_file_text(some_camera(), {}, origin), "test");
    expect_near(copied.at(0, origin), some_camera());
    EXPECT_EQ(copied.keys.at(0).position.y, 4);
    EXPECT_NEAR(copied.keys.at(0).position.x, 1842025.1, 1e-6);
}

TEST(Bookmarks, NamesStayUnlikeEachOther) {
    OwnFolder const folder;
    Bookmarks bookmarks(folder.path() / "a.json");
    bookmarks.add(some_camera());
    bookmarks.add(some_camera());
    bookmarks.remove(0);
    bookmarks.add(some_camera());
    EXPECT_EQ(bookmarks.all()[0].name, "view 2");
    EXPECT_EQ(bookmarks.all()[1].name, "view 1");
}

TEST(Bookmarks, WhatIsSaidNamesTheKeyOfTheFirstNine) {
    std::vector<Bookmark> all;
    for (std::size_t i = 0; i < 10; ++i) {
        add_bookmark(all, some_camera());
        EXPECT_EQ(bookmark_added_text(all), "bookmark view " + std::to_string(i + 1) + " added" +
                                                (i < 9 ? ": Shift+" + std::to_string(i + 1) + " comes back here" : ""));
    }
    all.resize(most_bookmarks);
    EXPECT_THROW(add_bookmark(all, some_camera()), InputError);
}

TEST(Bookmarks, ABrokenFileIsOneLineAndIsKept) {
    OwnFolder const folder;
    std::string const deep = R"({"cameras": [)" + std::string(100000, '[') + std::string(100000, ']') + "]}";
    auto const file = folder.path() / "scene.json";
    for (std::string const& text :
         std::vector<std::string>{"", "{", "[]", R"({"cameras": 3})", R"({"cameras": [{"name": "a"}]})",
                                  R"({"cameras": [{"scene_camera": 0}]})",
                                  R"({"cameras": [{"name": 3, "position": [0,0,1], "target": [0,0,0]}]})",
                                  R"({"cameras": [{"position": [0,0,1e400], "target": [0,0,0]}]})", deep}) {
        std::ofstream(file) << text;
        Bookmarks bookmarks(file);
        EXPECT_TRUE(bookmarks.all().empty());
        EXPECT_NE(bookmarks.complaint().find(file.string()), std::string::npos) << text;
        EXPECT_EQ(bookmarks.complaint().find('\n'), std::string::npos);
        bookmarks.add(some_camera());
        std::ostringstream kept;
        kept << std::ifstream(file.string() + ".broken").rdbuf();
        EXPECT_EQ(kept.str(), text);
        EXPECT_EQ(Bookmarks(file).all().size(), 1u);
    }
}

TEST(Bookmarks, APipeInPlaceOfAFileIsNotRead) {
    OwnFolder const folder;
    auto const file = folder.path() / "scene.json";
    ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
    std::jthread writer([&] { std::ofstream(file) << R"({"cameras": []})"; }); // waits for somebody who reads
    EXPECT_NE(Bookmarks(file).complaint().find(file.string()), std::string::npos);
    int const reader = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    writer.join();
    ::close(reader);
}

TEST(Bookmarks, AFolderThatCannotBeWrittenIsALine) {
    OwnFolder const folder;
    std::ofstream(folder.path() / "file") << "in the way";
    Bookmarks bookmarks(folder.path() / "file" / "scene.json");
    EXPECT_THROW(bookmarks.add(some_camera()), InputError);
    EXPECT_EQ(bookmarks.all().size(), 1u); // for this run
    EXPECT_THROW(Bookmarks("").add(some_camera()), InputError);
}

TEST(Bookmarks, AreOfOneFileHoweverManyScenesHaveItsName) {
    OwnFolder const folder;
    ::setenv("XDG_CONFIG_HOME", folder.path().c_str(), 1);
    Bookmarks(bookmark_files("scene", 7)).add(some_camera());
    EXPECT_EQ(Bookmarks(bookmark_files("scene", 7)).all().size(), 1u);
    EXPECT_TRUE(Bookmarks(bookmark_files("scene", 8)).all().empty());
    EXPECT_TRUE(Bookmarks(bookmark_files("scene", 0)).all().empty());
    EXPECT_EQ(bookmark_files("scene", 0x1f).own.filename(), "scene-000000000000001f.json");
}

TEST(Bookmarks, WhatWasKeptByNameAloneIsWhereTheyBegin) {
    OwnFolder const folder;
    ::setenv("XDG_CONFIG_HOME", folder.path().c_str(), 1);
    Bookmarks(bookmark_files("scene", 0)).add(some_camera());
    Bookmarks one(bookmark_files("scene", 7));
    ASSERT_EQ(one.all().size(), 1u);
    one.remove(0);
    EXPECT_TRUE(Bookmarks(bookmark_files("scene", 7)).all().empty());
    EXPECT_EQ(Bookmarks(bookmark_files("scene", 8)).all().size(), 1u);
    std::ofstream(bookmark_files("scene", 0).own) << "broken";
    Bookmarks other(bookmark_files("scene", 8));
    EXPECT_NE(other.complaint(), "");
    other.add(some_camera());
    EXPECT_EQ(Bookmarks(bookmark_files("scene", 8)).complaint(), "");
    EXPECT_TRUE(std::filesystem::exists(bookmark_files("scene", 0).own)); // it may be another's as well
}

TEST(UserFiles, NamesOfScenesAreNoWaysToOtherFolders) {
    EXPECT_EQ(file_stem_of_scene("wind mill-2", 0), "wind mill-2");
    EXPECT_EQ(file_stem_of_scene("../../etc/passwd", 0), "_.._.._etc_passwd");
    EXPECT_EQ(file_stem_of_scene("", 0), "_");
    EXPECT_EQ(file_stem_of_scene(std::string(500, 'a'), 0).size(), 100u);
}

TEST(UserFiles, NewFilesNeverReplaceOthers) {
    OwnFolder const folder;
    auto const first = new_file_name(folder.path(), ".png");
    std::ofstream(first) << "a picture";
    EXPECT_NE(new_file_name(folder.path(), ".png"), first);
}

} // namespace
} // namespace framelet
