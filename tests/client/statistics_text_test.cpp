#include "client/statistics_text.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace framelet {
namespace {

TEST(StatisticsText, JsonHoldsTheFiguresAndNullForWhatWasNotReached) {
    ClientStatistics statistics;
    statistics.samples = 1000;
    statistics.bytes = 250;
    statistics.pixels = 2000;
    statistics.reconstruct_seconds = 6e-6;
    statistics.coverage = 0.5;
    RunFigures run;
    run.scene = "a \"scene\" \xff"; // not UTF-8
    run.viewport = {64, 48};
    run.frames = 7;
    auto const json = nlohmann::json::parse(statistics_json(statistics, run));
    EXPECT_EQ(json.at("width"), 64);
    EXPECT_EQ(json.at("frames"), 7);
    EXPECT_DOUBLE_EQ(json.at("bytes_per_sample"), 0.25);
    EXPECT_DOUBLE_EQ(json.at("reconstruct_ns_per_pixel"), 3);
    EXPECT_DOUBLE_EQ(json.at("coverage"), 0.5);
    EXPECT_TRUE(json.at("first_picture_seconds").is_null());
    EXPECT_EQ(json.at("converged"), false);
    EXPECT_TRUE(json.at("scene").get<std::string>().starts_with("a \"scene\""));
}

TEST(StatisticsText, NothingReceivedIsNoDivisionByZero) {
    std::string const text = statistics_summary({}, {});
    EXPECT_EQ(text.find("nan"), std::string::npos) << text;
    EXPECT_EQ(text.find("inf"), std::string::npos) << text;
    EXPECT_NE(text.find("never"), std::string::npos) << text;
}

} // namespace
} // namespace framelet
