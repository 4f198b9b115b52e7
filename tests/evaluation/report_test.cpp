// The report's sums and page, of figures with known answers.
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "tests/evaluation/report/report_charts.h"
#include "tests/evaluation/report/report_page.h"
#include "tests/evaluation/report/run_store.h"

namespace framelet::bench {
namespace {

ReportFigures figures() {
    ReportFigures result;
    for (double const machine : {2.0, 5.0}) {
        for (auto const& [scene, factor] : {std::pair{"stop", 1.0}, {"globe", 4.0}}) {
            result.runs.push_back({scene,
                                   "framed+h264",
                                   machine,
                                   0,
                                   1e-5,
                                   1e-3 * factor,
                                   0.1,
                                   1e-4,
                                   3,
                                   {{"moving", 2e-3}, {"settled", 1e-4}}});
            result.runs.push_back({scene, "oracle", machine, 0, 1e-5, 1e-6, 0.1, 1e-4, 3, {{"moving", 1e-6}}});
            result.runs.push_back({scene,
                                   "framelet",
                                   machine,
                                   0,
                                   1e-5,
                                   5e-4 * factor,
                                   0.05,
                                   1e-4,
                                   3,
                                   {{"moving", 1e-3}, {"settled", 2e-4}}});
        }
    }
    result.features = {{{"what", "+ mirrors"}, {"render_ns", 300}, {"other_ns", 40}, {"rays", 2}, {"bytes", 1}}};
    result.commits = {"abc"};
    return result;
}

TEST(Report, SpreadsAreGeometric) {
    Spread const spread = spread_of({1, 100, 10, 1000, 10000});
    EXPECT_NEAR(spread.mean, 100, 1e-9);
    EXPECT_NEAR(spread.low, 10, 1e-9);
    EXPECT_NEAR(spread.high, 1000, 1e-9);
}

TEST(Report, CurvesAreErrorsOverTheReferencesNoise) {
    Curves const chart = speed_chart(figures());
    ASSERT_EQ(chart.curves.size(), 3u);
    EXPECT_EQ(chart.curves[0].name, "framed+h264");
    ASSERT_EQ(chart.curves[0].x.size(), 2u);
    EXPECT_NEAR(chart.curves[0].x[1], 5, 1e-9);
    EXPECT_NEAR(chart.curves[0].y[0], 200, 1e-9) << "between a hundred and four hundred times the noise";
    EXPECT_EQ(chart.marks.size(), 3u);
}

TEST(Report, ALossIsMarkedAndTheOracleIsNoRival) {
    ReportOptions options;
    options.machines = {2, 5};
    std::string const page = report_page(figures(), options, {}, "framelet-bench report");
    EXPECT_NE(page.find("| `stop` | 0.50 framed+h264 | - | **2.00** framed+h264 |"), std::string::npos) << page;
    EXPECT_NE(page.find("Lost: 2 of 4. Median while something moves: 0.50."), std::string::npos) << page;
    EXPECT_NE(page.find("| + mirrors | 300 | 40 | 2.00 | 1.00 |"), std::string::npos) << page;
    EXPECT_EQ(page.find("real programs"), std::string::npos) << "none was run";
}

nlohmann::json live_figures(double psnr, double flip) {
    return {{"mse", std::pow(10, -0.1 * psnr)},
            {"psnr", psnr},
            {"ssim", 0.9},
            {"flip", flip},
            {"steadiness", 1e-3},
            {"gap_p99_ms", 30},
            {"server_busy", 0.5},
            {"pictures_per_second", 40},
            {"kB_per_second", 100}};
}

TEST(Report, TheRealProgramsStandBesideTheirBestRival) {
    ReportFigures with_live = figures();
    nlohmann::json warp = live_figures(33, 0.2);
    warp["spacing"] = 2;
    warp["margin"] = 0;
    with_live.live.push_back(
        {{"scene", "stop"},
         {"methods",
          {{"framed", live_figures(20, 0.05)}, {"framed+warp", warp}, {"framelet", live_figures(30, 0.1)}}}});
    ReportOptions options;
    options.machines = {2, 5};
    std::string const page = report_page(with_live, options, {}, "framelet-bench report");
    EXPECT_NE(page.find("| `stop` | `framed+warp` (2) | 30.00 / - / **33.00** | **0.900** / - / **0.900** | "
                        "**0.100** / - / 0.200 |"),
              std::string::npos)
        << page;
}

TEST(RunStore, WhatWasRunIsNotRunAgain) {
    auto const folder = std::filesystem::temp_directory_path() / ("framelet-report-" + std::to_string(getpid()));
    int runs = 0;
    auto const run = [&runs] { return nlohmann::json(++runs); };
    RunStore first(folder, "one", 2);
    EXPECT_EQ(first.get("a", run), 1);
    EXPECT_EQ(first.get("a", run), 1);
    RunStore second(folder, "two", 2);
    EXPECT_EQ(second.get("a", run), 1);
    EXPECT_EQ(second.get("b", run), 2);
    EXPECT_EQ(second.commits(), (std::set<std::string>{"one", "two"}));
    std::ofstream(folder / "a.json") << "half of it";
    EXPECT_EQ(second.get("a", run), 3);
    std::filesystem::remove_all(folder);
}

} // namespace
} // namespace framelet::bench
