#include "protocol/stream/local_token.h"

#include <cstdlib>
#include <fstream>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/error.h"
#include "protocol/stream/user_folders.h"

namespace framelet {
namespace {

std::string const here = "127.0.0.1:7070";

/// Gives each test a home folder of its own, and no runtime folder that exists.
class LocalTokenFile : public testing::Test {
protected:
    void SetUp() override {
        std::string pattern = testing::TempDir() + "local-token-XXXXXX";
        ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
        home_ = pattern;
        ::setenv("HOME", home_.c_str(), 1);
        ::setenv("XDG_RUNTIME_DIR", (home_ / "runtime").c_str(), 1);
        ::unsetenv("XDG_STATE_HOME");
    }
    void TearDown() override { std::filesystem::remove_all(home_); }

    std::filesystem::path the_file() const {
        for (auto const& entry : std::filesystem::directory_iterator(state())) {
            if (entry.path().filename() != "lock") {
                return entry.path();
            }
        }
        ADD_FAILURE() << "there is none";
        return {};
    }
    std::filesystem::path state() const { return home_ / ".local" / "state" / "framelet"; }

    std::filesystem::path home_;
};

TEST_F(LocalTokenFile, TheSameUserFindsItWhileTheServerLives) {
    {
        LocalToken const token({here, "[::1]:7070"});
        EXPECT_EQ(read_local_token(here), token.token());
        EXPECT_EQ(read_local_token("[::1]:7070"), token.token());
        EXPECT_EQ(read_local_token("127.0.0.1:7071"), "") << "whoever listens there is to learn nothing";
        struct stat found {};
        ASSERT_EQ(::stat(the_file().c_str(), &found), 0);
        EXPECT_EQ(found.st_mode & 0777, 0600u);
        LocalToken const other({"127.0.0.1:7071"});
        EXPECT_NE(other.token(), token.token());
        EXPECT_EQ(read_local_token(here), token.token());
    }
    EXPECT_EQ(read_local_token(here), "");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(state()), {}), 1) << "the lock";
}

TEST_F(LocalTokenFile, APipeInPlaceOfAFileIsNotWaitedFor) {
    std::filesystem::path file;
    {
        LocalToken const token({here});
        file = the_file();
    }
    ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
    EXPECT_EQ(read_local_token(here), "");
    LocalToken const token({here});
    EXPECT_EQ(read_local_token(here), token.token());
}

/// Another user could, of a folder that others may read.
TEST_F(LocalTokenFile, WhoeverLocksTheFolderHoldsNobodyUp) {
    ASSERT_TRUE(make_private_folder(state()));
    std::filesystem::permissions(state(), std::filesystem::perms(0755));
    int const folder = ::open(state().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    ASSERT_EQ(::flock(folder, LOCK_EX), 0);
    LocalToken const token({here});
    EXPECT_EQ(read_local_token(here), token.token());
    EXPECT_EQ(std::filesystem::status(state() / "lock").permissions(), std::filesystem::perms(0600));
    ::close(folder);
}

TEST_F(LocalTokenFile, TheRuntimeFolderComesFirst) {
    ASSERT_TRUE(make_private_folder(home_ / "runtime"));
    LocalToken const token({here});
    EXPECT_FALSE(std::filesystem::exists(state()));
    EXPECT_EQ(read_local_token(here), token.token());
}

/// A server that was killed leaves its file behind.
TEST_F(LocalTokenFile, WhatIsLeftOfOthersGoes) {
    std::filesystem::path file;
    {
        LocalToken const token({here});
        file = the_file();
        std::filesystem::copy(file, file.string() + "0");
        std::filesystem::copy(file, home_ / "kept");
    }
    std::filesystem::copy(home_ / "kept", file);
    LocalToken const token({here});
    EXPECT_EQ(the_file(), file);
    EXPECT_FALSE(std::filesystem::exists(file.string() + "0"));
    EXPECT_EQ(read_local_token(here), token.token());
    ASSERT_TRUE(make_private_folder(home_ / "runtime"));
    LocalToken const next({here}); // its file is in another folder
    EXPECT_EQ(read_local_token(here), next.token());
}

TEST_F(LocalTokenFile, WhatOthersCanWriteIsNotBelieved) {
    LocalToken const token({here});
    std::filesystem::permissions(the_file(), std::filesystem::perms(0644));
    EXPECT_EQ(read_local_token(here), "");
    std::filesystem::permissions(the_file(), std::filesystem::perms(0600));
    std::filesystem::permissions(state(), std::filesystem::perms(0777));
    EXPECT_EQ(read_local_token(here), "");
    std::filesystem::permissions(state(), std::filesystem::perms(0700));
    EXPECT_EQ(read_local_token(here), token.token());
    std::filesystem::rename(the_file(), home_ / "elsewhere");
    EXPECT_EQ(read_local_token(here), "");
}

TEST_F(LocalTokenFile, WithoutAHomeThereIsATemporaryFolder) {
    ::setenv("HOME", "/dev/null", 1);
    LocalToken const token({"127.0.0.1:0"});
    EXPECT_EQ(read_local_token("127.0.0.1:0"), token.token());
    EXPECT_TRUE(is_private_folder("/tmp/framelet-" + std::to_string(::geteuid())));
}

} // namespace
} // namespace framelet
