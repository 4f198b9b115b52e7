// Tests the lines of a log that programs read.
#include "server/program/log.h"

#include <algorithm>
#include <chrono>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

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

} // namespace
} // namespace framelet
