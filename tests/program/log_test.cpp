// Tests the lines of a log that programs read.
#include "server/program/log.h"

#include <algorithm>
#include <array>
#include <chrono>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "common/counted.h"
#include "common/error.h"

namespace framelet {
namespace {

using namespace std::chrono_literals;

TEST(JsonLog, TimeLevelAndMessageAreThere) {
    spdlog::log_clock::time_point const time(1'740'821'400s + 7'900us);
    EXPECT_EQ(json_log_line(time, "info", "viewer 1 connects"),
              "{\"time\":\"2025-03-01T09:30:00.007Z\",\"level\":\"info\",\"message\":\"viewer 1 connects\"}\n");
    EXPECT_TRUE(json_log_line({}, "warning", "").starts_with("{\"time\":\"1970-01-01T00:00:00.000Z\""));
}

TEST(JsonLog, OneLineWhateverIsSaid) {
    std::string every;
    for (int c = 0; c < 256; ++c) {
        every += static_cast<char>(c);
    }
    for (std::string const& message :
         {every, std::string("a \"quoted\\\" name\r\n{\"level\":\"info\"}"), std::string("\xff\xfe \xc3")}) {
        std::string const line = json_log_line({}, "error", message);
        EXPECT_EQ(std::ranges::count(line, '\n'), 1) << line;
        EXPECT_EQ(line.back(), '\n');
        EXPECT_EQ(nlohmann::json::parse(line)["level"], "error");
    }
    std::string const text = "m\xc3\xbchle \"a\\b\"\n\t\x01";
    EXPECT_EQ(nlohmann::json::parse(json_log_line({}, "info", text))["message"], text);
}

TEST(JsonLog, FormatsAreTextAndJson) {
    EXPECT_EQ(parse_log_format("text"), LogFormat::text);
    EXPECT_EQ(parse_log_format("json"), LogFormat::json);
    EXPECT_THROW(parse_log_format("JSON"), InputError);
}

/// A server whose log goes into a pipe that nobody reads used to stand still once that was full.
TEST(Log, LinesThatNobodyReadsAreDroppedAndCounted) {
    int ends[2];
    ASSERT_EQ(::pipe2(ends, O_NONBLOCK | O_CLOEXEC), 0);
    ::fcntl(ends[1], F_SETFL, 0);
    int const errors = ::dup(STDERR_FILENO);
    ASSERT_EQ(::dup2(ends[1], STDERR_FILENO), STDERR_FILENO);
    auto const read_all = [&] {
        std::string text;
        std::array<char, 4096> some;
        for (ssize_t bytes = 0; (bytes = ::read(ends[0], some.data(), some.size())) > 0;) {
            text.append(some.data(), static_cast<std::size_t>(bytes));
        }
        return text;
    };
    open_log(LogFormat::text, false);
    constexpr std::size_t lines = 10'000;
    for (std::size_t i = 0; i < lines; ++i) {
        spdlog::info("a viewer that has nothing to say and a long way to say it in");
    }
    std::string const before = read_all();
    spdlog::info("the last line");
    std::string const after = read_all();
    ::dup2(errors, STDERR_FILENO);
    for (int const descriptor : {ends[0], ends[1], errors}) {
        ::close(descriptor);
    }
    auto const written = static_cast<std::size_t>(std::ranges::count(before, '\n'));
    EXPECT_GT(written, 0u);
    EXPECT_EQ(before.back(), '\n');
    EXPECT_NE(after.find("warning dropped " + counted(lines - written, "line") + " that nobody read\n"),
              std::string::npos)
        << after;
    EXPECT_NE(after.find("the last line\n"), std::string::npos) << after;
}

} // namespace
} // namespace framelet
