// Tests what the programs print where a file is called so that it would forge a line or tell the terminal something.
#include <csignal>
#include <filesystem>
#include <sstream>

#include <gtest/gtest.h>

#include "client/processes/private_server.h"
#include "tests/loopback/process.h"

namespace framelet::test {
namespace {

using namespace std::chrono_literals;

std::string const scene_file = FRAMELET_SOURCE_DIR "/scenes/windmill.glb";
constexpr auto patience = 120s;

/// A name that a line ends in, and that has ESC, C1 in UTF-8 and alone, and DEL.
std::string const odd_name = "a\nlistening on 203.0.113.1:7\nb\x1b[2J\xc2\x9b"
                             "31m\x9b"
                             "31m\x7f";

/// A folder with two scenes, one of which is called so.
class OddScene {
public:
    OddScene() {
        std::filesystem::create_symlink(scene_file, odd());
        std::filesystem::create_symlink(scene_file, plain());
    }
    std::string odd() const { return (folder_.path() / (odd_name + ".glb")).string(); }
    std::string plain() const { return (folder_.path() / "plain.glb").string(); }

private:
    TemporaryFolder folder_;
};

/// The text has no byte that a terminal obeys but the ends of lines, and as many lines that begin so.
void expect_lines(std::string const& text, std::string const& start, int count) {
    for (char const* const bad : {"\x1b", "\x9b", "\x7f"}) {
        EXPECT_EQ(text.find(bad), std::string::npos) << text;
    }
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        count -= line.starts_with(start);
    }
    EXPECT_EQ(count, 0) << text;
}

TEST(PrintedLine, OfAnOddFileName) {
    OddScene const scene;
    ServerProcess server(scene.odd(), {scene.plain(), "--paused"});
    server.process().signal(SIGTERM);
    EXPECT_EQ(server.process().wait(patience), 0);
    EXPECT_TRUE(server.address().starts_with("127.0.0.1:")) << server.address();
    expect_lines(server.process().output(), "listening on ", 1);
    expect_lines(server.process().errors(), "listening on ", 0);
    expect_lines(server.process().errors(), "b", 0);
}

TEST(PrintedLine, OfWhatCannotBeUsed) {
    Process scene(FRAMELET_SERVER, {odd_name + ".glb"});
    EXPECT_EQ(scene.wait(patience), 1);
    expect_lines(scene.errors(), "", 1);
    Process option(FRAMELET_SERVER, {"--" + odd_name});
    EXPECT_EQ(option.wait(patience), 2);
    expect_lines(option.errors(), "", 1);
    Process client(FRAMELET_CLIENT, {"127.0.0.1:1", "--token-file", odd_name});
    EXPECT_EQ(client.wait(patience), 1);
    expect_lines(client.errors(), "", 1);
}

TEST(PrintedLine, NoSceneTellsAPrivateServersViewerWhereToGo) {
    OddScene const scene;
    PrivateServer server({scene.odd(), scene.plain()}, {"--insecure"}, [] {});
    EXPECT_TRUE(eventually([&] { return server.address().has_value(); }));
    EXPECT_TRUE(server.address()->starts_with("127.0.0.1:")) << *server.address();
}

} // namespace
} // namespace framelet::test
