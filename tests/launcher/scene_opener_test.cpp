// Tests of what the window does with scene files, with the real server.
#include "client/window/scene_opener.h"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "common/error.h"
#include "tests/loopback/process.h"

namespace framelet::test {
namespace {

std::string const windmill = FRAMELET_SOURCE_DIR "/scenes/windmill.glb";
std::string const chase = FRAMELET_SOURCE_DIR "/scenes/vehicle_chase.glb";

std::unique_ptr<ClientCore> connect(ConnectionOptions const& options) {
    return std::make_unique<ClientCore>(options);
}

/// The session with the file's scene; nothing where the file is not opened.
std::optional<Connection> opened(SceneOpener& opener, std::string const& file) {
    opener.open({file});
    std::optional<Connection> out;
    EXPECT_TRUE(eventually([&] { return (out = opener.poll()) || opener.opening().empty(); }));
    return out;
}

/// The only child of this process.
pid_t server_process() {
    pid_t out = 0;
    std::ifstream("/proc/self/task/" + std::to_string(::getpid()) + "/children") >> out;
    return out;
}

TEST(SceneOpener, OpensOneSceneAfterAnother) {
    SceneOpener opener(connect, [] {});
    std::optional<Connection> const first = opened(opener, windmill);
    ASSERT_TRUE(first) << opener.take_complaint();
    EXPECT_EQ(first->core->welcome().scene_name, "windmill");
    EXPECT_TRUE(opener.has_open());
    EXPECT_EQ(opener.end_reason(), "");
    pid_t const former = server_process();
    std::optional<Connection> const second = opened(opener, chase);
    ASSERT_TRUE(second) << opener.take_complaint();
    EXPECT_EQ(second->core->welcome().scene_name, "vehicle_chase");
    EXPECT_NE(::kill(former, 0), 0);
    EXPECT_THROW(connect(first->options), ConnectionError);
    EXPECT_EQ(opener.take_complaint(), "");
}

TEST(SceneOpener, WhatIsNoSceneIsOneLineAndChangesNothing) {
    TemporaryFolder const folder;
    SceneOpener opener(connect, [] {});
    std::optional<Connection> const open = opened(opener, windmill);
    ASSERT_TRUE(open) << opener.take_complaint();
    for (std::string const& file : {folder.write("wrong.glb", "nonsense"), folder.write("wrong.txt", "nonsense"),
                                    (folder.path() / "absent.glb").string(), std::string("--help")}) {
        EXPECT_FALSE(opened(opener, file)) << file;
        std::string const complaint = opener.take_complaint();
        EXPECT_NE(complaint.find("'" + file + "'"), std::string::npos) << complaint;
        EXPECT_EQ(std::ranges::count(complaint, '\n'), 0) << complaint;
        EXPECT_EQ(opener.take_complaint(), "");
    }
    EXPECT_FALSE(opened(opener, folder.path().string()));
    EXPECT_NE(opener.take_complaint().find("it is a folder"), std::string::npos);
    EXPECT_FALSE(open->core->end_reason() || open->core->interruption());
    EXPECT_EQ(opener.end_reason(), "");
}

TEST(SceneOpener, ShowsSeveralFilesTogether) {
    SceneOpener opener(connect, [] {});
    opener.open({windmill, chase});
    EXPECT_EQ(opener.opening(), "windmill.glb and 1 more");
    std::optional<Connection> open;
    EXPECT_TRUE(eventually([&] { return (open = opener.poll()) || opener.opening().empty(); }));
    ASSERT_TRUE(open) << opener.take_complaint();
    EXPECT_EQ(open->core->welcome().scene_name, "windmill + vehicle_chase");
    ::kill(server_process(), SIGKILL);
    EXPECT_TRUE(eventually([&] { return !opener.end_reason().empty(); }));
    opener.reopen();
    EXPECT_TRUE(eventually([&] { return (open = opener.poll()) || opener.opening().empty(); }));
    ASSERT_TRUE(open) << opener.take_complaint();
    EXPECT_EQ(open->core->welcome().scene_name, "windmill + vehicle_chase");
}

TEST(SceneOpener, TheNewestCounts) {
    SceneOpener opener(connect, [] {});
    opener.open({chase});
    EXPECT_EQ(opener.opening(), "vehicle_chase.glb");
    std::optional<Connection> const open = opened(opener, windmill);
    ASSERT_TRUE(open) << opener.take_complaint();
    EXPECT_EQ(open->core->welcome().scene_name, "windmill");
    EXPECT_EQ(opener.opening(), "");
    EXPECT_FALSE(opener.poll());
}

TEST(SceneOpener, SaysThatItsServerHasGoneAndStartsAnother) {
    SceneOpener opener(connect, [] {});
    std::optional<Connection> open = opened(opener, windmill);
    ASSERT_TRUE(open) << opener.take_complaint();
    ::kill(server_process(), SIGKILL);
    EXPECT_TRUE(eventually([&] { return !opener.end_reason().empty(); }));
    EXPECT_EQ(opener.end_reason(), "framelet-server was ended by a signal: Killed");
    opener.reopen();
    EXPECT_TRUE(eventually([&] { return (open = opener.poll()) || opener.opening().empty(); }));
    EXPECT_TRUE(open) << opener.take_complaint();
    EXPECT_EQ(opener.end_reason(), "");
}

TEST(SceneOpener, WhatCouldNotBeOpenedIsTriedAgainAndHasTheExitCodeOfItsServer) {
    TemporaryFolder const folder;
    SceneOpener opener(connect, [] {});
    EXPECT_FALSE(opener.can_reopen());
    std::string const file = folder.write("scene.glb", "nonsense");
    EXPECT_FALSE(opened(opener, file));
    EXPECT_EQ(opener.exit_code(), 1);
    ASSERT_TRUE(opener.can_reopen());
    std::filesystem::copy_file(windmill, file, std::filesystem::copy_options::overwrite_existing);
    opener.reopen();
    std::optional<Connection> open;
    EXPECT_TRUE(eventually([&] { return (open = opener.poll()) || opener.opening().empty(); }));
    EXPECT_TRUE(open) << opener.take_complaint();
    EXPECT_EQ(opener.exit_code(), 0);
    SceneOpener misused(connect, [] {}, {"--threads=x"});
    EXPECT_FALSE(opened(misused, windmill));
    EXPECT_EQ(misused.exit_code(), 2);
}

TEST(SceneOpener, EndsTheServerThatIsNotLookedAtAnyMore) {
    SceneOpener opener(connect, [] {});
    std::optional<Connection> const open = opened(opener, windmill);
    ASSERT_TRUE(open) << opener.take_complaint();
    opener.close();
    EXPECT_FALSE(opener.has_open());
    EXPECT_THROW(connect(open->options), ConnectionError);
    EXPECT_EQ(opener.end_reason(), "");
}

TEST(SceneOpener, ShowsHowFarTheFileIsLoaded) {
    SceneOpener opener(connect, [] {});
    OverlayContent nothing;
    opener.show(nothing);
    EXPECT_EQ(nothing, OverlayContent());
    opener.open({chase});
    bool has_stage = false;
    EXPECT_TRUE(eventually([&] {
        OverlayContent content;
        opener.show(content);
        has_stage = has_stage || (content.progress && content.sign.starts_with("opening vehicle_chase.glb: "));
        return opener.poll() || opener.opening().empty();
    }));
    EXPECT_TRUE(has_stage);
}

TEST(SceneOpener, OtherScenesHaveTheOptionsThatCountForAny) {
    SceneOpener opener(connect, [] {},
                       {"--paused", "--clip=none", "--scene=none", "--up", "z", "--record-events",
                        "/nonexistent/events", "--metrics-bind=wrong"});
    opener.open_first({windmill}, {});
    EXPECT_TRUE(eventually([&] { return opener.poll() || opener.opening().empty(); }));
    EXPECT_NE(opener.take_complaint(), "");
    EXPECT_NE(opener.exit_code(), 0);
    std::optional<Connection> const other = opened(opener, chase);
    ASSERT_TRUE(other) << opener.take_complaint();
    EXPECT_FALSE(other->core->clock().playing);
}

TEST(SceneOpener, ServesTheFirstSceneWithOptionsThatItGivesItself) {
    SceneOpener opener(connect, [] {}, {"--log", "json", "--port", "0", "--paused"});
    opener.open_first({windmill}, {});
    std::optional<Connection> open;
    EXPECT_TRUE(eventually([&] { return (open = opener.poll()) || opener.opening().empty(); }));
    ASSERT_TRUE(open) << opener.take_complaint();
    EXPECT_FALSE(open->core->clock().playing);
}

TEST(SceneOpener, WhoMayConnectIsAskedOfTheFirstSceneAlone) {
    TemporaryFolder const folder;
    std::string const token = folder.write("token", "0123456789abcdef0123456789abcdef\n");
    SceneOpener opener(connect, [] {}, {"--token-file", token, "--control-token-file=" + token, "--paused"});
    std::optional<Connection> const open = opened(opener, windmill);
    ASSERT_TRUE(open) << opener.take_complaint();
    EXPECT_FALSE(open->core->clock().playing);
}

TEST(SceneOpener, ServesTheFirstSceneWithAllOptionsAlsoOnceMore) {
    SceneOpener opener(connect, [] {}, {"--clip=absent"});
    opener.open_first({windmill}, {});
    for (int i = 0; i < 2; ++i) {
        EXPECT_TRUE(eventually([&] { return opener.poll() || opener.opening().empty(); }));
        std::string const complaint = opener.take_complaint();
        EXPECT_NE(complaint.find("'absent'"), std::string::npos) << complaint;
        opener.reopen();
    }
}

TEST(SceneOpener, SaysThatThereIsNoServerToStart) {
    TemporaryFolder const folder;
    std::filesystem::path const alone = folder.path() / "launcher_test";
    std::filesystem::copy_file("/proc/self/exe", alone);
    if (!std::getenv("FRAMELET_TEST_ALONE")) {
        ::setenv("FRAMELET_TEST_ALONE", "1", 1); // beside the tests is the server
        Process process(alone, {"--gtest_filter=SceneOpener.SaysThatThereIsNoServerToStart"});
        EXPECT_EQ(process.wait(std::chrono::seconds(120)), 0) << process.output();
        return;
    }
    ::setenv("PATH", "/nonexistent", 1);
    SceneOpener opener(connect, [] {});
    EXPECT_FALSE(opened(opener, windmill));
    EXPECT_NE(opener.take_complaint().find("cannot find framelet-server"), std::string::npos);
}

} // namespace
} // namespace framelet::test
