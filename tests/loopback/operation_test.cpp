// What those who run the programs meet: what is asked of a scene without serving it, options in a file.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/loopback/process.h"

namespace framelet::test {
namespace {

using namespace std::chrono_literals;

std::string const scene_file = FRAMELET_SOURCE_DIR "/scenes/windmill.glb";
constexpr auto patience = 120s;

bool has(std::string const& text, std::string const& part) {
    return text.find(part) != std::string::npos;
}

TEST(Operation, InfoSaysWhatIsInASceneAndServesNothing) {
    Process text(FRAMELET_SERVER, {"--info", scene_file});
    EXPECT_EQ(text.wait(patience), 0) << text.errors();
    EXPECT_TRUE(has(text.output(), "1 camera") && has(text.output(), "vane wheel")) << text.output();
    EXPECT_FALSE(has(text.output(), "listening"));
    Process json(FRAMELET_SERVER, {"--info", "--json", scene_file});
    EXPECT_EQ(json.wait(patience), 0) << json.errors();
    EXPECT_EQ(nlohmann::json::parse(json.output())["moving_bodies"].size(), 2u) << json.output();
    Process absent(FRAMELET_SERVER, {"--info", "absent.glb"});
    EXPECT_EQ(absent.wait(patience), 1);
    EXPECT_TRUE(has(absent.errors(), "absent.glb")) << absent.errors();
    Process alone(FRAMELET_SERVER, {"--json", scene_file});
    EXPECT_EQ(alone.wait(patience), 2);
    EXPECT_TRUE(has(alone.errors(), "--info")) << alone.errors();
}

TEST(Operation, OptionsComeFromAFileToo) {
    TemporaryFolder const folder;
    std::string const file = folder.write("server.toml", "scene = \"" + scene_file + "\"\nport = 1\npaused = true\n");
    ServerProcess const server =
        ServerProcess::of_program(FRAMELET_SERVER, {"--config", file, "--port", "0", "--insecure"});
    std::string const client_file =
        folder.write("client.toml", "host = \"" + server.address() + "\"\nsize = \"64x64\"\njson = true\n");
    Process client(FRAMELET_CLIENT, {"--config", client_file, "--until-converged"});
    EXPECT_EQ(client.wait(patience), 0) << client.errors();
    EXPECT_EQ(nlohmann::json::parse(client.output())["width"], 64);

    Process wrong(FRAMELET_SERVER, {scene_file, "--config", folder.write("wrong.toml", "prot = 7070\n")});
    EXPECT_EQ(wrong.wait(patience), 2);
    EXPECT_TRUE(has(wrong.errors(), "wrong.toml") && has(wrong.errors(), "'prot'")) << wrong.errors();
    Process absent(FRAMELET_CLIENT, {"--config", (folder.path() / "absent.toml").string()});
    EXPECT_EQ(absent.wait(patience), 1);
    EXPECT_TRUE(has(absent.errors(), "absent.toml")) << absent.errors();
}

} // namespace
} // namespace framelet::test
