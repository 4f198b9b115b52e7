// Runs docs/python_client.py, which knows of the protocol what PROTOCOL.md says: its picture is the one that
// framelet-client has of the same scene.
#include <cstdlib>
#include <vector>

#include <gtest/gtest.h>

#include "common/files/image_io.h"
#include "tests/loopback/process.h"

namespace framelet::test {
namespace {

using namespace std::chrono_literals;

std::string const scene_file = FRAMELET_SOURCE_DIR "/scenes/vehicle_chase.glb";
std::string const program = FRAMELET_SOURCE_DIR "/docs/python_client.py";
std::string const python = "/usr/bin/python3"; // the Python that Debian's packages are for
constexpr auto patience = 120s;

class PythonClient : public testing::Test {
protected:
    void SetUp() override {
        Process packages(python, {"-c", "import flatbuffers, numpy, zstandard"});
        Process compiler("/bin/sh", {"-c", "flatc --version"});
        if (packages.wait(patience) != 0 || compiler.wait(patience) != 0) {
            GTEST_SKIP() << "python3-flatbuffers, python3-numpy, python3-zstandard or flatbuffers-compiler is missing";
        }
        token_ = folder_.write("token", "0123456789abcdef0123456789abcdef\n");
    }

    std::string file(std::string const& name) const { return (folder_.path() / name).string(); }

    TemporaryFolder folder_;
    std::string token_;
};

TEST_F(PythonClient, ShowsWhatFrameletClientShows) {
    ServerProcess server(scene_file, {"--paused", "--token-file", token_});
    Process theirs(python,
                   {program, server.address(), file("python.ppm"), "--token-file", token_, "--size", "211x120"});
    ASSERT_EQ(theirs.wait(patience), 0) << theirs.errors();
    Process ours(FRAMELET_CLIENT, {server.address(), "--token-file", token_, "--size", "211x120", "--until-converged",
                                   "--duration", "100", "--output", file("client.ppm")});
    ASSERT_EQ(ours.wait(patience), 0) << ours.errors();
    Picture const picture = read_picture(file("python.ppm")), expected = read_picture(file("client.ppm"));
    ASSERT_EQ(picture.width, 211);
    ASSERT_EQ(picture.rgba.size(), expected.rgba.size());
    double sum = 0;
    for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
        sum += std::abs(int{picture.rgba[i]} - int{expected.rgba[i]});
    }
    // The bound allows for a server so slow that ten seconds are not enough, where the finest samples are missing.
    EXPECT_LT(sum / static_cast<double>(picture.rgba.size()), 2) << "levels of 255";
}

TEST_F(PythonClient, WhatIsNewerShowsThenWhatIsFiner) {
    Process process(python, {"-c", R"(
import sys; sys.dont_write_bytecode = True; sys.path.insert(0, sys.argv[1])
from numpy import full, uint8
from python_client import paint
grey = lambda value: full((16, 16, 3), value, uint8)
print([[int(paint({1: (whole, grey(9)), 4: (quarter, grey(7))}, 32, 32)[row, row, 0]) for row in (0, 31)]
       for whole, quarter in ((1, 1), (1, 2), (2, 1))])
)",
                             FRAMELET_SOURCE_DIR "/docs"});
    ASSERT_EQ(process.wait(patience), 0) << process.errors();
    EXPECT_EQ(process.output(), "[[7, 9], [7, 9], [9, 9]]\n");
}

TEST_F(PythonClient, SaysWhatIsWrongInOneLine) {
    ServerProcess server(scene_file, {"--paused", "--token-file", token_});
    struct Case {
        std::vector<std::string> arguments;
        int code;
        std::string word;
    };
    for (auto const& [arguments, code, word] :
         {Case{{server.address(), file("none.ppm")}, 1, "token"},
          Case{{server.address(), file("none.ppm"), "--token-file", file("missing")}, 1, "missing"},
          Case{{"127.0.0.1:1", file("none.ppm")}, 1, "refused"},
          Case{{server.address(), file("none.ppm"), "--size", "0x9"}, 2, "WIDTHxHEIGHT"}}) {
        std::vector<std::string> all = arguments;
        all.insert(all.begin(), program);
        Process process(python, all);
        EXPECT_EQ(process.wait(patience), code) << word;
        EXPECT_NE(process.errors().find(word), std::string::npos) << process.errors();
        EXPECT_EQ(process.errors().find("Traceback"), std::string::npos) << process.errors();
    }
}

} // namespace
} // namespace framelet::test
