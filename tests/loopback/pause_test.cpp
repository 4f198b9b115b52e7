// Programs that stand still for a while, as under a debugger, on a machine that sleeps or in a container that is
// frozen: what was going on goes on.
#include <csignal>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/files/image_io.h"
#include "tests/loopback/process.h"

namespace framelet::test {
namespace {

using namespace std::chrono_literals;

constexpr auto patience = 120s;
constexpr auto pause = 7s; ///< longer than a viewer waits for a word from its server

/// A camera path, as JSON, that flies for so many seconds and then stands.
std::string flight(double seconds) {
    nlohmann::json const keys = {{{"time", 0}, {"position", {9, 4, 12}}, {"target", {0, 1, 0}}},
                                 {{"time", seconds}, {"position", {-6, 3, -10}}, {"target", {0, 1, 0}}}};
    return nlohmann::json{{"keys", keys}}.dump();
}

/// A client that ends once its picture is complete, at the end of a flight.
class FlyingClient {
public:
    FlyingClient(std::string const& address, double seconds)
        : process_(FRAMELET_CLIENT,
                   {address, "--size", "160x90", "--duration", "100", "--until-converged", "--json", "--camera",
                    folder_.write("camera.json", flight(seconds)), "--output", picture_file().string()}) {}

    Process& process() { return process_; }
    Picture finish() {
        EXPECT_EQ(process_.wait(patience), 0) << process_.errors();
        return std::filesystem::exists(picture_file()) ? read_picture(picture_file()) : Picture();
    }
    std::uint64_t reconnections() const { return nlohmann::json::parse(process_.output()).at("reconnections"); }

private:
    std::filesystem::path picture_file() const { return folder_.path() / "last.png"; }

    TemporaryFolder folder_;
    Process process_;
};

struct Paused : testing::Test {
    ServerProcess server{FRAMELET_SOURCE_DIR "/scenes/vehicle_chase.glb", {"--paused", "--exposure", "0"}};
    Picture const whole = FlyingClient(server.address(), 0.1).finish();

    /// The final picture, where one of the two programs has been stopped for a while in the middle of a flight.
    Picture after_pause(FlyingClient& client, Process& stopped) {
        std::this_thread::sleep_for(2s);
        EXPECT_TRUE(client.process().running()) << client.process().errors();
        stopped.signal(SIGSTOP);
        std::this_thread::sleep_for(pause);
        stopped.signal(SIGCONT);
        return client.finish();
    }
};

TEST_F(Paused, AViewerGoesOnWhereItWas) {
    FlyingClient client(server.address(), 10);
    EXPECT_EQ(after_pause(client, client.process()), whole);
    EXPECT_EQ(client.reconnections(), 0u) << "it hears first what came meanwhile";
}

TEST_F(Paused, AServerIsGivenUpAndComeBackTo) {
    FlyingClient client(server.address(), 10);
    EXPECT_EQ(after_pause(client, server.process()), whole);
    EXPECT_NE(client.process().errors().find("stopped answering"), std::string::npos) << client.process().errors();
    EXPECT_GE(client.reconnections(), 1u);
}

} // namespace
} // namespace framelet::test
