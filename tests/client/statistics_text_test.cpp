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
    run.scene_seconds = 9.25;
    auto const json = nlohmann::json::parse(statistics_json(statistics, run));
    EXPECT_EQ(json.at("width"), 64);
    EXPECT_EQ(json.at("frames"), 7);
    EXPECT_EQ(json.at("scene_seconds"), 9.25) << "as the last line of --frames has it";
    EXPECT_DOUBLE_EQ(json.at("bytes_per_sample"), 0.25);
    EXPECT_DOUBLE_EQ(json.at("reconstruct_ns_per_pixel"), 3);
    EXPECT_DOUBLE_EQ(json.at("coverage"), 0.5);
    EXPECT_TRUE(json.at("first_picture_seconds").is_null());
    EXPECT_EQ(json.at("converged"), false);
    EXPECT_TRUE(json.at("scene").get<std::string>().starts_with("a \"scene\""));
}

TEST(StatisticsText, WhatPeopleAskForStandsBeforeTheDetails) {
    ClientStatistics statistics;
    statistics.seconds = 2;
    statistics.pictures = 60;
    statistics.bytes = 1000000;
    statistics.batches = 1;
    statistics.coverage = 0.5;
    RunFigures run;
    run.photon_seconds = 0.042;
    std::string const text = statistics_summary(statistics, run);
    std::string const people = text.substr(0, text.find("\ndetails\n"));
    for (char const* const part : {"30.0 a second", "4.0 Mbit/s", "42 ms", "50.0% of the picture known, coarse"}) {
        EXPECT_NE(people.find(part), std::string::npos) << part << " in\n" << text;
    }
    EXPECT_EQ(people.find("ns/"), std::string::npos) << text;
    EXPECT_NE(text.find("1 batch, "), std::string::npos) << text;
    EXPECT_DOUBLE_EQ(nlohmann::json::parse(statistics_json(statistics, run)).at("motion_to_photon_seconds"), 0.042);
}

TEST(StatisticsText, NothingReceivedIsNoDivisionByZero) {
    std::string const text = statistics_summary({}, {});
    EXPECT_EQ(text.find("nan"), std::string::npos) << text;
    EXPECT_EQ(text.find("inf"), std::string::npos) << text;
    EXPECT_NE(text.find("never"), std::string::npos) << text;
}

} // namespace
} // namespace framelet
