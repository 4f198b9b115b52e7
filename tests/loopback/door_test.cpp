// Several servers of one scene behind HAProxy, configured as it is packaged.
#include <algorithm>
#include <csignal>
#include <fstream>
#include <sstream>
#include <thread>

#include <gtest/gtest.h>

#include "tests/loopback/metrics_page.h"
#include "tests/loopback/process.h"
#include "tests/loopback/shown_frames.h"

namespace framelet::test {
namespace {

using namespace std::chrono_literals;

std::string const scene_file = FRAMELET_SOURCE_DIR "/scenes/windmill.glb";
constexpr auto patience = 120s;
std::string const haproxy = "/usr/sbin/haproxy";

std::string port_of(std::string const& address) {
    return address.substr(address.rfind(':') + 1);
}

std::string replaced(std::string text, std::string const& from, std::string const& to) {
    std::size_t const at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// A server as the configuration wants it.
struct Served {
    ServerProcess server{scene_file,
                         {"--insecure", "--proxied", "127.0.0.1", "--metrics", "0", "--max-sessions", "64", "--drain",
                          "1000", "--nice", "0"}};
    std::string metrics = metrics_address(server);

    double sessions() { return metric(ask(metrics, "/metrics").body(), "framelet_sessions"); }
};

/// HAProxy before two servers.
class Door {
public:
    Door(Served const& one, Served const& two) {
        std::ostringstream packaged;
        packaged << std::ifstream(FRAMELET_SOURCE_DIR "/cmake/packaging/many/haproxy.cfg").rdbuf();
        std::string text = replaced(packaged.str(), "bind :7070", "bind 127.0.0.1:" + port_);
        text = replaced(text, "check port 7071", "check");
        text = replaced(text, "10.0.0.11:7070", one.server.address() + " port " + port_of(one.metrics));
        text = replaced(text, "10.0.0.12:7070", two.server.address() + " port " + port_of(two.metrics));
        haproxy_ = std::make_unique<Process>(haproxy,
                                             std::vector<std::string>{"-db", "-f", folder_.write("haproxy.cfg", text)});
        EXPECT_TRUE(eventually([&] { return can_connect(); })) << haproxy_->errors();
    }

    std::string address() const { return "127.0.0.1:" + port_; }

private:
    bool can_connect() const {
        boost::asio::io_context io;
        boost::system::error_code error;
        tcp::socket socket(io);
        socket.connect({boost::asio::ip::address_v4::loopback(), static_cast<std::uint16_t>(std::stoi(port_))}, error);
        return !error;
    }

    TemporaryFolder folder_;
    std::string port_ = free_port();
    std::unique_ptr<Process> haproxy_;
};

TEST(Door, AllSeePicturesAgainWhenOneOfTwoServersIsKilled) {
    if (!std::filesystem::exists(haproxy)) {
        GTEST_SKIP() << "there is no " << haproxy;
    }
    constexpr int viewers = 16;
    Served one, two;
    Door const door(one, two);
    TemporaryFolder const folder;
    std::vector<std::unique_ptr<Process>> clients;
    for (int i = 0; i < viewers; ++i) {
        clients.push_back(std::make_unique<Process>(
            FRAMELET_CLIENT,
            std::vector<std::string>{door.address(), "--size", "160x90", "--rate", "20", "--duration", "1000",
                                     "--frames", folder.path() / (std::to_string(i) + ".json")}));
    }
    ASSERT_TRUE(eventually([&] { return one.sessions() + two.sessions() == viewers; }));
    EXPECT_GT(one.sessions(), 0);
    EXPECT_GT(two.sessions(), 0);
    std::this_thread::sleep_for(2s); // all have pictures
    double const killed = std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
    one.server.process().signal(SIGKILL);
    EXPECT_TRUE(eventually([&] { return two.sessions() == viewers; }));
    double longest = 0;
    for (std::size_t i = 0; i < clients.size(); ++i) {
        std::vector<Shown> shown;
        EXPECT_TRUE(eventually([&] {
            shown = shown_in(folder.read(std::to_string(i) + ".json"));
            auto const after = std::ranges::find_if(shown, [&](Shown const& frame) { return frame.seconds > killed; });
            return after != shown.end() && shown.back().samples > after->samples;
        })) << "viewer "
            << i;
        longest = std::max(longest, longest_gap(shown, killed));
        clients[i]->signal(SIGTERM);
        EXPECT_EQ(clients[i]->wait(patience), 0) << clients[i]->errors();
    }
    std::printf("the longest time without a new sample: %.2f s\n", longest);
}

TEST(Door, AServerThatDrainsKeepsItsViewersAndGetsNoMore) {
    if (!std::filesystem::exists(haproxy)) {
        GTEST_SKIP() << "there is no " << haproxy;
    }
    Served one, two;
    Door const door(one, two);
    Process first(FRAMELET_CLIENT, {door.address(), "--size", "64x64", "--rate", "10", "--duration", "1000"});
    ASSERT_TRUE(eventually([&] { return one.sessions() + two.sessions() == 1; }));
    Served& ending = one.sessions() == 1 ? one : two;
    Served& other = one.sessions() == 1 ? two : one;
    ending.server.process().signal(SIGTERM);
    ASSERT_TRUE(eventually([&] { return ask(ending.metrics, "/ready").result() == http::status::not_found; }));
    EXPECT_EQ(ask(ending.metrics, "/health").result(), http::status::ok);
    std::this_thread::sleep_for(1500ms); // two checks
    for (int i = 0; i < 4; ++i) {
        Process next(FRAMELET_CLIENT, {door.address(), "--size", "64x64", "--rate", "10", "--duration", "1"});
        EXPECT_EQ(next.wait(patience), 0) << next.errors();
    }
    EXPECT_EQ(metric(ask(other.metrics, "/metrics").body(), "framelet_viewers_total"), 4);
    EXPECT_TRUE(first.running());
    first.signal(SIGTERM);
    EXPECT_EQ(first.wait(patience), 0) << first.errors();
    EXPECT_EQ(first.errors().find("connection"), std::string::npos) << first.errors();
    EXPECT_EQ(ending.server.process().wait(patience), 0) << "its last viewer has left";
}

TEST(Door, AFullServerIsNotReady) {
    ServerProcess server(scene_file, {"--insecure", "--metrics", "0", "--max-sessions", "1"});
    std::string const metrics = metrics_address(server);
    EXPECT_EQ(ask(metrics, "/ready").body(), "ready\n");
    Process viewer(FRAMELET_CLIENT, {server.address(), "--size", "64x64", "--duration", "60"});
    EXPECT_TRUE(eventually([&] { return ask(metrics, "/ready").result() == http::status::not_found; }));
    viewer.signal(SIGTERM);
    EXPECT_TRUE(eventually([&] { return ask(metrics, "/ready").result() == http::status::ok; }));
}

} // namespace
} // namespace framelet::test
