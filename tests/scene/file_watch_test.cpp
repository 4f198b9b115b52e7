// Watches files that change, are replaced, removed and come back, while the clock is set by hand.
#include "server/scene/file_watch.h"

#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

namespace framelet {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

struct Watched : testing::Test {
    fs::path folder = fs::path(testing::TempDir()) / ("framelet_watch" + std::to_string(::getpid()));
    fs::path file = folder / "scene.gltf", beside = folder / "scene.bin";
    FileWatch watch;
    FileWatch::Time now{1000s};

    Watched() {
        fs::create_directories(folder);
        write(file, "one");
        watch.watch(std::vector{file, beside});
    }
    ~Watched() override { fs::remove_all(folder); }

    static void write(fs::path const& path, std::string const& text) { std::ofstream(path) << text; }
    bool after(FileWatch::Time::duration time) { return watch.look(now += time); }
};

TEST_F(Watched, ChangesAreToldOnceWhenTheyAreOver) {
    EXPECT_FALSE(after(0s));
    EXPECT_FALSE(after(10s));
    write(file, "one and a half");
    EXPECT_FALSE(after(250ms));
    EXPECT_FALSE(after(250ms));
    write(file, "one and a half, and more");
    EXPECT_FALSE(after(250ms)) << "it is still being written";
    EXPECT_FALSE(after(250ms));
    EXPECT_TRUE(after(250ms));
    EXPECT_FALSE(after(10s));
}

TEST_F(Watched, AnotherFileInItsPlaceAndOneThatComesCount) {
    fs::path const next = folder / "next";
    write(next, "two");
    fs::last_write_time(next, fs::last_write_time(file));
    fs::rename(next, file);
    EXPECT_FALSE(after(0s));
    EXPECT_TRUE(after(FileWatch::quiet));
    write(beside, "bytes");
    EXPECT_FALSE(after(0s));
    EXPECT_TRUE(after(FileWatch::quiet));
    fs::remove_all(folder);
    EXPECT_FALSE(after(0s));
    EXPECT_TRUE(after(FileWatch::quiet));
    fs::create_directories(folder);
    write(file, "one");
    EXPECT_FALSE(after(0s));
    EXPECT_TRUE(after(FileWatch::quiet));
}

TEST_F(Watched, WhatIsKnownOfAFileStaysWhereItIsWatchedOn) {
    write(file, "changed before anybody looked");
    watch.watch(std::vector{file});
    EXPECT_FALSE(after(0s));
    EXPECT_TRUE(after(FileWatch::quiet));
    write(beside, "of no account any more");
    EXPECT_FALSE(after(0s));
    EXPECT_FALSE(after(FileWatch::quiet));
}

} // namespace
} // namespace framelet
