// The real server while others do it no good: connections that say nothing, guesses of the token, no file descriptors,
// a log that nobody reads, a terminal that is gone, and arguments that are found to be wrong before the scene is
// loaded.
#include <array>
#include <csignal>
#include <deque>
#include <thread>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/loopback/process.h"
#include "tests/session/raw_viewer.h"

namespace framelet::test {
namespace {

using namespace std::chrono_literals;

std::string const scene_file = FRAMELET_SOURCE_DIR "/scenes/vehicle_chase.glb";
constexpr auto patience = 120s;

std::uint16_t port_of(ServerProcess const& server) {
    return static_cast<std::uint16_t>(std::stoi(server.address().substr(server.address().rfind(':') + 1)));
}

/// Connections that say this, or nothing, and stay.
class SilentConnections {
public:
    SilentConnections(std::uint16_t port, std::size_t count, std::string const& words = {}) {
        for (std::size_t i = 0; i < count; ++i) {
            sockets_.emplace_back(io_).connect({boost::asio::ip::address_v4::loopback(), port});
            sockets_.back().send(boost::asio::buffer(words));
        }
    }

private:
    boost::asio::io_context io_;
    std::vector<boost::asio::ip::tcp::socket> sockets_;
};

/// Runs a client; returns what it says on stderr, one line, where it could not see a picture, otherwise nothing.
std::string connect_client(ServerProcess const& server, std::vector<std::string> more = {}) {
    more.insert(more.begin(), {server.address(), "--size", "64x64", "--duration", "60", "--until-converged"});
    Process client(FRAMELET_CLIENT, more);
    return client.wait(patience) == 0 ? "" : client.errors() + "(failed)";
}

/// Starts the server by a shell that runs these commands before.
ServerProcess server_after(std::string const& shell, std::vector<std::string> const& options) {
    std::vector<std::string> arguments{"-c", shell + "exec \"$0\" \"$@\"", FRAMELET_SERVER, scene_file, "--port", "0"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return ServerProcess::of_program("/bin/sh", arguments);
}

std::size_t lines_in(std::string const& text) {
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

TEST(Unwelcome, ConnectionsWithoutAHelloLockNobodyOut) {
    TemporaryFolder folder;
    std::string const token = folder.write("token", "0123456789abcdef0123456789abcdef\n");
    ServerProcess server(scene_file, {"--token-file", token, "--paused"});
    SilentConnections const silent(port_of(server), 80);
    EXPECT_EQ(connect_client(server, {"--token-file", token}), "");
}

TEST(Unwelcome, WhoLosesItsPlaceIsToldWhy) {
    TemporaryFolder folder;
    std::string const token = folder.write("token", "0123456789abcdef0123456789abcdef\n");
    ServerProcess server(scene_file, {"--token-file", token, "--paused"});
    for (int wrong = 0; wrong < 2; ++wrong) { // the connection is first read at once, then, after wrong tokens, not yet
        boost::asio::io_context io;
        boost::asio::ip::tcp::socket socket(io);
        socket.connect({boost::asio::ip::address_v4::loopback(), port_of(server)});
        SilentConnections const others(port_of(server), 200);
        std::string told(4096, '\0');
        boost::system::error_code error;
        told.resize(socket.read_some(boost::asio::buffer(told), error));
        EXPECT_NE(told.find("try again"), std::string::npos) << told.size() << " bytes: " << error.message();
        for (int i = 0; i < 4; ++i) {
            RawViewer(port_of(server), coding::all, "wrong").failure();
        }
    }
}

/// A browser may use the connection for its next request, and would take a word for the answer.
TEST(Unwelcome, WhoSaysNothingIsCutWithoutAWord) {
    ServerProcess server(scene_file, {"--paused"});
    boost::asio::io_context io;
    boost::asio::ip::tcp::socket socket(io);
    socket.connect({boost::asio::ip::address_v4::loopback(), port_of(server)});
    std::array<char, 64> told{};
    boost::system::error_code error;
    EXPECT_EQ(socket.read_some(boost::asio::buffer(told), error), 0u);
    EXPECT_EQ(error, boost::asio::error::eof) << error.message();
}

TEST(Unwelcome, WithoutFileDescriptorsItWaitsForThem) {
    ServerProcess server = server_after("ulimit -n 30; ", {"--paused"});
    {
        SilentConnections const silent(port_of(server), 100);
        EXPECT_TRUE(eventually([&] {
            return server.process().errors().find("cannot accept a connection") != std::string::npos;
        })) << "otherwise this tests nothing";
        std::this_thread::sleep_for(1s);
        EXPECT_LT(lines_in(server.process().errors()), 100u);
    }
    EXPECT_EQ(connect_client(server), "") << server.process().errors();
}

TEST(Unwelcome, RefusedConnectionsDoNotPileUp) {
    ServerProcess server(scene_file, {"--paused"});
    auto const open_files = [&] {
        std::filesystem::path const folder = "/proc/" + std::to_string(server.process().pid()) + "/fd";
        return std::distance(std::filesystem::directory_iterator(folder), {});
    };
    auto const before = open_files();
    std::string const a_message_that_is_none("\x01\0\0\0x", 5);
    std::ptrdiff_t most = 0;
    std::vector<std::unique_ptr<SilentConnections>> refused;
    for (int i = 0; i < 20; ++i) {
        refused.push_back(std::make_unique<SilentConnections>(port_of(server), 20, a_message_that_is_none));
        most = std::max(most, open_files() - before);
    }
    EXPECT_LT(most, 100) << "16 that wait, 64 that are told why they end";
    EXPECT_EQ(connect_client(server), "");
}

/// An IPv4 address of this machine by which others reach it, or empty.
std::string own_address() {
    boost::asio::io_context io;
    boost::asio::ip::udp::socket socket(io, boost::asio::ip::udp::v4());
    boost::system::error_code error; // connecting a datagram socket sends nothing: it chooses the address
    socket.connect({boost::asio::ip::make_address_v4("192.0.2.1"), 9}, error);
    return error ? "" : socket.local_endpoint().address().to_string();
}

TEST(Unwelcome, TheTokenIsNotSentToOtherMachinesInClear) {
    std::string const address = own_address();
    if (address.empty()) {
        GTEST_SKIP() << "this machine has no address but its own loopback";
    }
    TemporaryFolder folder;
    std::string const token = folder.write("token", "0123456789abcdef0123456789abcdef\n");
    ServerProcess server(scene_file, {"--bind", address, "--insecure", "--token-file", token, "--paused"});
    std::string const refused = connect_client(server, {"--token-file", token});
    EXPECT_NE(refused.find("--tls"), std::string::npos) << refused;
    EXPECT_EQ(lines_in(refused), 1u) << refused;
    EXPECT_EQ(connect_client(server, {"--token-file", token, "--insecure"}), "");
}

/// Returns what the server at this port says to a viewer that knows no token; empty where it lets it in.
std::string word_to_a_stranger(std::uint16_t port) {
    RawViewer viewer(port);
    bool const welcome = viewer.watch([](Message const& message) { return !std::holds_alternative<Failure>(message); });
    return welcome ? "" : viewer.failure();
}

TEST(Unwelcome, OtherUsersOfThisMachineAreRefused) {
    ServerProcess server(scene_file, {"--paused"});
    EXPECT_NE(word_to_a_stranger(port_of(server)).find("token"), std::string::npos);
    EXPECT_EQ(connect_client(server), "") << "of the same user, without any option";
    ServerProcess open(scene_file, {"--paused", "--insecure"});
    EXPECT_EQ(word_to_a_stranger(port_of(open)), "");
    EXPECT_EQ(connect_client(open), "");
}

/// The environment is bare as in a container, or for a job of the system.
TEST(Unwelcome, WithoutAnEnvironmentTheSameUserIsLetInToo) {
    for (std::string const forget : {"unset XDG_RUNTIME_DIR XDG_STATE_HOME HOME; ", "HOME=/dev/null/none; "}) {
        ServerProcess server = server_after(forget, {"--paused"});
        EXPECT_NE(word_to_a_stranger(port_of(server)).find("token"), std::string::npos);
        EXPECT_EQ(connect_client(server), "") << forget;
    }
}

TEST(Unwelcome, GuessesOfTheTokenAreSlowAndLogged) {
    TemporaryFolder folder;
    std::string const token = folder.write("token", "0123456789abcdef0123456789abcdef\n");
    ServerProcess server(scene_file, {"--token-file", token, "--paused", "--quiet"});
    auto const start = std::chrono::steady_clock::now();
    for (int i = 0; i < 5; ++i) {
        RawViewer viewer(port_of(server), coding::all, "guess " + std::to_string(i));
        EXPECT_NE(viewer.failure().find("token"), std::string::npos);
    }
    EXPECT_GE(std::chrono::steady_clock::now() - start, 3750ms) << "0, 1/4, 1/2, 1 and 2 s";
    EXPECT_NE(server.process().errors().find("wrong token from 127.0.0.1"), std::string::npos)
        << server.process().errors();
    EXPECT_LE(lines_in(server.process().errors()), 2u);
    EXPECT_EQ(connect_client(server, {"--token-file", token}), "");
}

TEST(Unwelcome, ShortTokensAreRefusedAndLongOnesAreMade) {
    TemporaryFolder folder;
    Process with_short(FRAMELET_SERVER, {scene_file, "--port", "0", "--token-file", folder.write("short", "x\n")});
    EXPECT_EQ(with_short.wait(30s), 1);
    EXPECT_NE(with_short.errors().find("--make-token"), std::string::npos) << with_short.errors();
    std::vector<std::string> made;
    for (int i = 0; i < 2; ++i) {
        Process maker(FRAMELET_SERVER, {"--make-token"});
        EXPECT_EQ(maker.wait(30s), 0) << maker.errors();
        made.push_back(maker.output());
        EXPECT_EQ(lines_in(made.back()), 1u);
    }
    EXPECT_NE(made[0], made[1]);
    std::string const token = folder.write("made", made[0]);
    ServerProcess const server(scene_file, {"--token-file", token, "--paused"});
    EXPECT_EQ(connect_client(server, {"--token-file", token}), "");
}

TEST(Unwelcome, ALogThatNobodyReadsEndsNothing) {
    TemporaryFolder folder;
    std::string const pipe = (folder.path() / "log").string();
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    int const reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    ServerProcess server = server_after("exec 2>'" + pipe + "'; ", {"--paused"});
    ::close(reader);
    EXPECT_EQ(connect_client(server), "");
    EXPECT_EQ(connect_client(server), "") << "of whom the log says that it came, and that another left";
    EXPECT_TRUE(server.process().running());
}

TEST(Unwelcome, APipeInPlaceOfAFileKeepsNoServerFromStarting) {
    TemporaryFolder folder;
    std::string const file = folder.write("file", "no certificate\n");
    std::vector<std::string> const options{"--token-file", "--control-token-file", "--record-events", "--config",
                                           "--tls-cert"};
    std::deque<Process> servers; // all at once: some wait a while for a line
    std::vector<std::string> pipes;
    for (std::string const& option : options) {
        pipes.push_back((folder.path() / ("pipe" + option)).string());
        ASSERT_EQ(::mkfifo(pipes.back().c_str(), 0600), 0);
        std::vector<std::string> arguments{scene_file, "--port", "0", option, pipes.back()};
        if (option == "--tls-cert") {
            arguments.insert(arguments.end(), {"--tls-key", file});
        }
        servers.emplace_back(FRAMELET_SERVER, arguments);
    }
    for (std::size_t i = 0; i < servers.size(); ++i) {
        EXPECT_EQ(servers[i].wait(patience), 1) << options[i];
        EXPECT_EQ(lines_in(servers[i].errors()), 1u) << servers[i].errors();
        EXPECT_NE(servers[i].errors().find(pipes[i]), std::string::npos) << options[i];
    }
}

TEST(Unwelcome, APipeInPlaceOfAFileKeepsNoViewerFromStarting) {
    TemporaryFolder folder;
    std::string const pipe = (folder.path() / "pipe").string();
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    ServerProcess const server(scene_file, {"--paused", "--insecure"});
    for (std::string const option : {"--config", "--camera"}) {
        std::string const refused = connect_client(server, {option, pipe});
        EXPECT_EQ(lines_in(refused), 1u) << refused;
        EXPECT_NE(refused.find(pipe), std::string::npos) << option << ": " << refused;
    }
}

TEST(Unwelcome, ATokenMayComeOutOfAPipe) {
    std::string const token = "0123456789abcdef0123456789abcdef";
    TemporaryFolder folder;
    ServerProcess const server = ServerProcess::of_program(
        "/bin/bash", {"-c", "exec \"$0\" \"$1\" --port 0 --paused --token-file <(sleep 0.2; echo " + token + ")",
                      FRAMELET_SERVER, scene_file});
    EXPECT_EQ(connect_client(server, {"--token-file", folder.write("token", token)}), "");
}

/// Else a connection would be 0, 1 or 2, and get what is meant for the log.
TEST(Unwelcome, ClosedDescriptorsBecomeNoConnections) {
    ServerProcess server = server_after("exec 0<&- 2>&-; ", {"--paused"});
    EXPECT_EQ(connect_client(server), "");
    for (char const* const number : {"0", "2"}) {
        std::filesystem::path const file = "/proc/" + std::to_string(server.process().pid()) + "/fd/" + number;
        EXPECT_EQ(std::filesystem::read_symlink(file), "/dev/null");
    }
}

TEST(Unwelcome, AHangUpWhileTheSceneLoadsEndsNothing) {
    TemporaryFolder folder;
    std::filesystem::path const record = folder.path() / "events";
    Process server(FRAMELET_SERVER, {scene_file, "--port", "0", "--paused", "--record-events", record.string()});
    ASSERT_TRUE(eventually([&] { return std::filesystem::exists(record); })); // before it begins to load
    server.signal(SIGHUP);
    EXPECT_TRUE(eventually([&] {
        return server.errors().find("the scene is not loaded again") != std::string::npos || !server.running();
    }));
    EXPECT_TRUE(server.running());
    EXPECT_NE(server.output().find("listening on"), std::string::npos);
}

TEST(Unwelcome, ViewersThatComeAndGoDoNotFillTheLog) {
    ServerProcess server(scene_file, {"--paused", "--insecure"});
    for (int i = 0; i < 300; ++i) {
        RawViewer viewer(port_of(server));
        ASSERT_TRUE(viewer.watch([](Message const& message) { return std::holds_alternative<Welcome>(message); }));
    }
    EXPECT_LT(lines_in(server.process().errors()), 300u) << server.process().errors();
    EXPECT_NE(server.process().errors().find("viewer 1 connects"), std::string::npos);
}

TEST(Unwelcome, WhenTheServerIsToldToEndViewersHearOfIt) {
    ServerProcess server(scene_file, {"--paused", "--insecure"});
    RawViewer viewer(port_of(server));
    ASSERT_TRUE(viewer.watch([](Message const& message) { return std::holds_alternative<Welcome>(message); }));
    server.process().signal(SIGTERM);
    EXPECT_EQ(viewer.failure(), "the server shuts down");
    EXPECT_EQ(server.process().wait(30s), 0);
}

TEST(Unwelcome, UnderNohupItGoesOnWithoutATerminal) {
    ServerProcess server = server_after("trap '' HUP; ", {"--paused"});
    server.process().signal(SIGHUP);
    EXPECT_EQ(connect_client(server), "");
}

TEST(Unwelcome, WrongArgumentsAreFoundBeforeTheSceneIsLoaded) {
    TemporaryFolder folder;
    std::string const text = folder.write("notes.txt", "neither a picture nor a certificate");
    ServerProcess const first(scene_file, {"--paused"});
    struct Wrong {
        std::vector<std::string> arguments;
        std::string says;
    };
    Wrong const cases[] = {
        {{"--port", std::to_string(port_of(first))}, std::to_string(port_of(first))},
        {{"--bind", "no.such.host.invalid", "--insecure"}, "no.such.host.invalid"},
        {{"--port", "0", "--tls-cert", text, "--tls-key", text}, "TLS certificate"},
        {{"--port", "0", "--environment", text}, "notes.txt"},
        {{"--port", "0", "--record-events", text + "/events"}, "notes.txt/events"},
    };
    for (Wrong const& wrong : cases) {
        std::vector<std::string> arguments{"/nonexistent/scene.glb"};
        arguments.insert(arguments.end(), wrong.arguments.begin(), wrong.arguments.end());
        Process process(FRAMELET_SERVER, arguments);
        EXPECT_EQ(process.wait(60s), 1);
        EXPECT_NE(process.errors().find(wrong.says), std::string::npos) << process.errors();
        EXPECT_EQ(process.errors().find("scene.glb"), std::string::npos) << process.errors();
    }
}

} // namespace
} // namespace framelet::test
