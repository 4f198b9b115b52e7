// Tests what becomes of a scene file that a process of its own reads first, by programs that do what that could do.
#include "server/scene/reading/import_check.h"

#include <csignal>

#include <fcntl.h>
#include <gtest/gtest.h>

#include "common/error.h"
#include "gltf_writer.h"
#include "server/scene/scene_import.h"

namespace framelet {
namespace {

class ImportCheck : public testing::Test {
protected:
    TemporaryFolder const folder_;
    std::filesystem::path const file_ = folder_.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    ImportOptions options_;

    /// Lets the checker be a shell that runs these lines.
    void be(std::string const& lines) {
        options_.is_serving = true;
        options_.checker = folder_.write("checker", "#!/bin/sh\n" + lines + "\n");
        std::filesystem::permissions(options_.checker, std::filesystem::perms::owner_all);
    }

    /// What is wrong with the file; empty: nothing.
    std::string complaint() const {
        try {
            EXPECT_EQ(import_scene(file_, {}, options_).meshes.size(), 1u);
            return "";
        } catch (InputError const& error) {
            return error.what();
        }
    }
    std::string prefix() const { return "cannot load scene '" + file_.string() + "': "; }
};

TEST_F(ImportCheck, IsAskedAboutTheFileWithinTheSameLimits) {
    options_.memory_bytes = std::uint64_t(300) << 20;
    options_.allow_outside = true;
    options_.up = "z";
    options_.unit = "mm";
    be("echo \"$@\" > " + (folder_.path() / "asked").string());
    EXPECT_EQ(complaint(), "");
    std::ifstream asked(folder_.path() / "asked");
    std::string line;
    std::getline(asked, line);
    EXPECT_EQ(line, "--info --news 1 --quiet --scene-memory 300 --allow-outside --up z --unit mm -- " + file_.string());
}

TEST_F(ImportCheck, WhatItSaysIsSaidAsIfItHadBeenReadHere) {
    be("echo a warning >&2; echo \"framelet-server: cannot load scene '" + file_.string() +
       "': it is odd\" >&2; exit 1");
    EXPECT_EQ(complaint(), prefix() + "it is odd");
    be("exit 3");
    EXPECT_EQ(complaint(), prefix() + "the process that reads it first ends and does not say why");
}

TEST_F(ImportCheck, AProcessThatCrashesCostsNoOther) {
    be("kill -SEGV $$");
    EXPECT_EQ(complaint(), prefix() + "it ends the process that reads it: Segmentation fault");
    options_.checker = folder_.path() / "absent";
    EXPECT_NE(complaint().find("no process can be started"), std::string::npos);
}

TEST_F(ImportCheck, NothingThatIsOpenHereIsOpenThere) {
    int const open = ::open("/dev/null", O_RDONLY); // as sockets are, without O_CLOEXEC
    be("[ ! -e /proc/self/fd/" + std::to_string(open) + " ]");
    EXPECT_EQ(complaint(), "");
    ::close(open);
}

TEST_F(ImportCheck, IsEndedWithTheLoad) {
    struct Ended {};
    std::filesystem::path const number = folder_.path() / "number";
    be("echo $$ > " + number.string() + "; exec sleep 1000");
    int id = 0;
    auto const progress = [&](std::string_view, double) {
        if (std::ifstream(number) >> id) {
            throw Ended();
        }
    };
    EXPECT_THROW(import_scene(file_, progress, options_), Ended);
    EXPECT_NE(::kill(id, 0), 0);
}

TEST_F(ImportCheck, WhatMakesNoProgressIsEnded) {
    std::filesystem::path const number = folder_.path() / "number";
    be("echo $$ > " + number.string() + "; echo a sign of life; exec sleep 1000");
    options_.checker_patience = std::chrono::milliseconds(1500);
    EXPECT_EQ(complaint(), prefix() + "nothing has come of reading it for 1 second");
    int id = 0;
    ASSERT_TRUE(std::ifstream(number) >> id);
    EXPECT_NE(::kill(id, 0), 0);
}

/// It says more than a pipe holds, and closes its output before it ends.
TEST_F(ImportCheck, WhatItSaysOfItsProgressIsReadAndOfNoAccount) {
    be("i=0; while [ $i -lt 20000 ]; do echo loading $i; i=$((i+1)); done; exec >&-; sleep 0.3");
    EXPECT_EQ(complaint(), "");
}

TEST_F(ImportCheck, IsAskedAboutEveryFormat) {
    be("kill -SEGV $$"); // as a picture that its library cannot bear may do
    GltfWriter writer;
    writer.array(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 2, 0}, "VEC3");
    auto const gltf =
        folder_.write("a.glb", writer.glb(R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
                                          R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}])"));
    EXPECT_THROW(import_scene(gltf, {}, options_), InputError);
}

/// To read a file twice takes twice as long.
TEST_F(ImportCheck, AtTheStartIsAskedAboutTreesAlone) {
    be("kill -SEGV $$");
    options_.is_serving = false;
    EXPECT_EQ(complaint(), "");
    auto const tree = folder_.write("a.dae", "<COLLADA/>");
    try {
        import_scene(tree, {}, options_);
        ADD_FAILURE();
    } catch (InputError const& error) {
        EXPECT_NE(std::string(error.what()).find("Segmentation fault"), std::string::npos) << error.what();
    }
}

} // namespace
} // namespace framelet
