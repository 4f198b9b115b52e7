// The system's clock is set while a session is open: nothing notices, since nobody reads it to decide anything.
#include <atomic>
#include <chrono>
#include <ctime>
#include <fstream>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "client/core/client_core.h"
#include "tests/session/running_server.h"

namespace {

std::atomic<time_t> jump = 0; ///< seconds by which the system's clock has been set

} // namespace

/// Stands in for the library's function: whatever this program and its libraries read of the system's clocks goes
/// through here.
extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
    int const result = static_cast<int>(::syscall(SYS_clock_gettime, clock, time));
    if (result == 0 && clock == CLOCK_REALTIME) {
        time->tv_sec += jump;
    }
    return result;
}

namespace framelet::test {
namespace {

using namespace std::chrono_literals;

TEST(ClockJump, ASessionGoesOn) {
    RunningServer const server({}, moving_scene());
    ConnectionOptions options;
    options.server.port = server.port();
    options.reconnect = true;
    ClientCore core(options);
    core.request_clock({ClockRequest::time | ClockRequest::playing, {0, true, 1}});
    Picture picture;
    std::vector<PixelRect> changed;
    auto const batches_come = [&] {
        std::uint64_t const before = core.statistics().batches;
        auto const deadline = std::chrono::steady_clock::now() + 60s;
        while (core.statistics().batches < before + 5 && std::chrono::steady_clock::now() < deadline) {
            core.set_view(core.welcome().start_camera, {128, 96});
            core.update_picture(picture, changed);
            core.wait_for_news(10ms);
        }
        return core.statistics().batches >= before + 5;
    };
    ASSERT_TRUE(batches_come());
    auto const began = std::chrono::steady_clock::now();
    double const scene_began = core.clock().time;
    auto const real_time = std::chrono::system_clock::now();
    for (time_t const seconds : {86'400, -86'400, 400'000'000, -400'000'000, 0}) {
        jump = seconds;
        auto const jumped =
            std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now() - real_time);
        ASSERT_LT(std::abs(jumped.count() - seconds), 60) << "the clock has been set";
        EXPECT_TRUE(batches_come());
        EXPECT_EQ(core.statistics().reconnections, 0u);
        EXPECT_FALSE(core.interruption());
    }
    double const passed = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    EXPECT_NEAR(core.clock().time - scene_began, passed, 30) << "nor does the scene's clock jump";
}

/// Looks at the sources of all that is delivered: a certificate's dates are OpenSSL's, names of files and lines of logs
/// decide nothing.
TEST(ClockJump, NobodyReadsTheSystemsClockButForNamesAndLogs) {
    std::set<std::string> const names_and_logs{"client/window/kept/user_files.cpp",
                                               "client/windowless/windowless_run.cpp"};
    char const* const words[] = {"system_clock",   "std::time(", "::time(",    "gettimeofday",
                                 "CLOCK_REALTIME", "utc_clock",  "file_clock", "localtime"};
    std::filesystem::path const source = FRAMELET_SOURCE_DIR;
    std::set<std::string> readers;
    std::size_t files = 0;
    for (char const* const folder : {"common", "protocol", "server", "client"}) {
        for (auto const& entry : std::filesystem::recursive_directory_iterator(source / folder)) {
            std::string const extension = entry.path().extension();
            if (extension != ".cpp" && extension != ".h") {
                continue;
            }
            ++files;
            std::ifstream stream(entry.path());
            std::string const text{std::istreambuf_iterator<char>(stream), {}};
            for (char const* const word : words) {
                if (text.find(word) != std::string::npos) {
                    readers.insert(std::filesystem::relative(entry.path(), source).string());
                }
            }
        }
    }
    EXPECT_GT(files, 200u);
    EXPECT_EQ(readers, names_and_logs);
}

} // namespace
} // namespace framelet::test
