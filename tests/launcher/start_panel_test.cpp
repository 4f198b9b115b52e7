// Tests of the window without a session: what it waits for, the field for a server, scenes of the command line.
#include <csignal>

#include "tests/launcher/window_fixture.h"

namespace framelet::test {
namespace {

std::string const scene_file = FRAMELET_SOURCE_DIR "/scenes/windmill.glb";
constexpr char const* nobody = "127.0.0.1:1"; ///< where no server is

class StartPanelTest : public WindowFixture {
protected:
    void start_viewer(std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), {"--size", "640x480"});
        start(FRAMELET_VIEWER, arguments);
        ASSERT_TRUE(has_window()) << program_->errors();
    }
    static bool has_viewer(ServerProcess& server) { return has(server.process().errors(), "viewer 1 connects"); }
    static bool gets_viewer(ServerProcess& server) {
        return eventually([&] { return has_viewer(server); });
    }
    /// Types into the field until something holds: what comes before the field has the keys is lost.
    static void enter_until(std::string const& address, std::function<bool()> const& holds) {
        enter(address);
        for (int y = screen_height / 3; y < screen_height && !eventually_soon(holds); y += 12) {
            click(screen_width / 2, y);
            enter(address);
        }
    }
    static bool eventually_soon(std::function<bool()> const& holds) {
        for (int i = 0; i < 100 && !holds(); ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
        return holds();
    }
    /// Closes the window by its key; the exit code.
    int close() {
        input({"key", "--delay", "200", "ctrl+q"});
        return program_->wait(patience);
    }
};

TEST_F(StartPanelTest, AServerIsTypedIn) {
    ServerProcess server(scene_file, {"--insecure"});
    start_viewer({});
    EXPECT_EQ(program_->errors(), "") << "nothing is tried before the user says what";
    enter_until(server.address(), [&] { return has_viewer(server); });
    EXPECT_TRUE(gets_viewer(server)) << program_->errors();
    program_->signal(SIGTERM);
    EXPECT_EQ(program_->wait(patience), 0) << program_->errors();
    EXPECT_TRUE(has(memory(), server.address())) << memory();
}

TEST_F(StartPanelTest, EnterAloneTriesThisMachine) {
    start_viewer({});
    input({"key", "--delay", "200", "Return"});
    EXPECT_TRUE(eventually([&] { return has(program_->errors(), "localhost:7070"); })) << program_->errors();
    EXPECT_TRUE(program_->running());
}

TEST_F(StartPanelTest, AServerOfBeforeIsClickedOn) {
    ServerProcess server(scene_file, {"--insecure"});
    std::filesystem::create_directory(folder_.path() / "framelet");
    std::filesystem::permissions(folder_.path() / "framelet", std::filesystem::perms::owner_all);
    folder_.write("framelet/viewer.json", "{\"servers\": [\"" + server.address() + "\"]}");
    start_viewer({});
    // The list is below the field, at the left edge of the panel, which is in the middle.
    for (int y = screen_height / 2; y < screen_height && !has_viewer(server); y += 6) {
        click(screen_width / 4, y);
    }
    EXPECT_TRUE(gets_viewer(server)) << program_->errors();
}

TEST_F(StartPanelTest, ARefusalIsToldAndAnotherServerTyped) {
    std::string const token = folder_.write("token", "0123456789abcdef0123456789abcdef\n");
    ServerProcess strict(scene_file, {"--token-file", token});
    ServerProcess open(scene_file, {"--insecure"});
    start_viewer({});
    enter_until(strict.address(), [&] { return has(program_->errors(), "token"); });
    ASSERT_TRUE(has(program_->errors(), "token")) << program_->errors();
    std::string const refusal = program_->errors().substr(program_->errors().find("token"));
    EXPECT_FALSE(has(refusal.substr(0, refusal.find('\n')), "waiting for it")) << refusal;
    EXPECT_FALSE(has(refusal, "--token-file")) << "there is a field for it: " << refusal;
    EXPECT_TRUE(program_->running());
    for (int y = screen_height / 3; y < screen_height && !has_viewer(open); y += 12) {
        click(screen_width / 2, y); // into the field at last
        enter(open.address());
    }
    EXPECT_TRUE(gets_viewer(open)) << program_->errors();
    start(FRAMELET_VIEWER, {strict.address()}); // of the command line it is the end
    EXPECT_EQ(program_->wait(patience), 1);
    EXPECT_TRUE(has(program_->errors(), "--token-file")) << program_->errors();
}

TEST_F(StartPanelTest, ATokenThatIsRefusedIsTypedAnewWithoutAClick) {
    std::string const words = "0123456789abcdef0123456789abcdef";
    ServerProcess strict(scene_file, {"--token-file", folder_.write("token", words + "\n")});
    start_viewer({});
    enter_until(strict.address(), [&] { return has(program_->errors(), "token"); });
    auto const is_let_in = [&] { return has(strict.process().errors(), " connects"); };
    for (int i = 0; i < 10 && !eventually_soon(is_let_in); ++i) {
        enter(words);
    }
    EXPECT_TRUE(is_let_in()) << program_->errors();
}

TEST_F(StartPanelTest, ACertificateThatNobodyVouchesForIsAskedAbout) {
    std::string const key = (folder_.path() / "key.pem").string(), certificate = (folder_.path() / "cert.pem").string();
    Process openssl("/usr/bin/openssl",
                    {"req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "1", "-keyout", key, "-out", certificate,
                     "-subj", "/CN=localhost", "-addext", "subjectAltName=IP:127.0.0.1"});
    ASSERT_EQ(openssl.wait(patience), 0) << openssl.errors();
    ServerProcess server(scene_file, {"--tls-cert", certificate, "--tls-key", key, "--paused"});
    std::filesystem::path const known = folder_.path() / "framelet" / "known_servers";
    start_viewer({server.address(), "--tls"});
    ASSERT_TRUE(eventually([&] { return has(program_->errors(), "no authority vouches"); })) << program_->errors();
    EXPECT_FALSE(has(program_->errors(), "framelet-viewer asks")) << "this one does: " << program_->errors();
    EXPECT_FALSE(has(content_of(known), server.address())) << "nobody has said so yet";
    EXPECT_FALSE(has(server.process().errors(), "connects")) << "nothing has been sent";
    // The answers are below the text; the right one says yes.
    auto const connects = [&] { return has(server.process().errors(), " connects"); };
    for (int y = screen_height / 2; y < screen_height && !connects(); y += 6) {
        click(250, y);
    }
    EXPECT_TRUE(eventually(connects)) << program_->errors();
    EXPECT_TRUE(has(content_of(known), server.address()));
    EXPECT_EQ(close(), 0) << program_->errors();
    start_viewer({server.address(), "--tls"});
    EXPECT_TRUE(eventually([&] {
        std::string const log = server.process().errors();
        return log.find(" connects") != log.rfind(" connects");
    }));
    EXPECT_EQ(program_->errors(), "") << "it is known by now";
}

TEST_F(StartPanelTest, ClosingItIsFine) {
    start_viewer({});
    EXPECT_EQ(close(), 0) << program_->errors();
    EXPECT_TRUE(has(memory(), "640")) << memory();
    start_viewer({nobody});
    EXPECT_EQ(close(), 0) << program_->errors();
}

TEST_F(StartPanelTest, EscapeAsksOnceWhetherToQuit) {
    start_viewer({nobody});
    input({"key", "Escape"});
    std::this_thread::sleep_for(std::chrono::seconds(2));
    EXPECT_TRUE(program_->running()) << program_->errors();
    EXPECT_TRUE(eventually([&] { // a key may come late, in a machine with much to do
        input({"key", "--delay", "300", "Escape", "Escape"});
        return !program_->running();
    }));
    EXPECT_EQ(program_->wait(patience), 0) << program_->errors();
}

TEST_F(StartPanelTest, ASignalEndsItAndTheSettingsAreKept) {
    for (int const number : {SIGINT, SIGTERM, SIGHUP}) {
        start_viewer({nobody});
        program_->signal(number);
        EXPECT_EQ(program_->wait(patience), 0) << program_->errors();
        EXPECT_TRUE(has(memory(), "640")) << memory();
        std::filesystem::remove(folder_.path() / "framelet" / "viewer.json");
    }
}

TEST_F(StartPanelTest, ALostSessionIsFollowedByOneThatIsTypedIn) {
    ServerProcess server(scene_file, {"--insecure", "--paused"});
    ServerProcess other(scene_file, {"--insecure", "--paused"});
    start_viewer({server.address(), "--no-reconnect"});
    ASSERT_TRUE(gets_viewer(server)) << program_->errors();
    server.process().signal(SIGTERM);
    EXPECT_EQ(server.process().wait(patience), 0);
    ASSERT_TRUE(eventually([&] { return !program_->errors().empty(); }));
    // Beside the field a click is the camera's, and what is typed are keys that do no harm.
    for (int y = screen_height / 3; y < screen_height && !has_viewer(other); y += 12) {
        click(screen_width / 2, y);
        enter(other.address());
    }
    EXPECT_TRUE(gets_viewer(other)) << program_->errors();
    program_->signal(SIGTERM);
    EXPECT_EQ(program_->wait(patience), 0) << program_->errors();
    EXPECT_TRUE(has(memory(), other.address())) << memory();
}

TEST_F(StartPanelTest, ASceneOfTheCommandLineThatIsBrokenIsToldAndTriedAgain) {
    std::string const file = folder_.write("scene.glb", "nonsense");
    start_viewer({"--open", file});
    EXPECT_TRUE(eventually([&] { return has(program_->errors(), "framelet-viewer: "); })) << program_->errors();
    EXPECT_TRUE(has(program_->errors(), file)) << program_->errors();
    std::filesystem::copy_file(scene_file, file, std::filesystem::copy_options::overwrite_existing);
    EXPECT_TRUE(eventually([&] {
        press("r");
        std::this_thread::sleep_for(std::chrono::seconds(2));
        return has(program_->errors(), "viewer 1 connects");
    })) << program_->errors();
}

} // namespace
} // namespace framelet::test
