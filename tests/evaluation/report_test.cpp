// Tests the report's sums and page on figures with known answers.
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "tests/evaluation/report/goals.h"
#include "tests/evaluation/report/report_charts.h"
#include "tests/evaluation/report/report_page.h"
#include "tests/evaluation/report/report_text.h"
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
    ASSERT_EQ(chart.curves.size(), 2u);
    EXPECT_EQ(chart.curves[0].name, "framed+h264");
    ASSERT_EQ(chart.curves[0].x.size(), 2u);
    EXPECT_NEAR(chart.curves[0].x[1], 5, 1e-9);
    EXPECT_NEAR(chart.curves[0].y[0], 200, 1e-9) << "between a hundred and four hundred times the noise";
    EXPECT_EQ(chart.marks.size(), 3u);
}

TEST(Report, ParagraphsAreWrapped) {
    std::string const long_word(70, 'a');
    EXPECT_EQ(wrapped("# Title\n\n" + long_word + " b\nc " + long_word + "\n\n    " + long_word + " " + long_word +
                      "\n| " + long_word + " | " + long_word + " |\n" + long_word),
              "# Title\n\n" + long_word + " b c\n" + long_word + "\n\n    " + long_word + " " + long_word + "\n| " +
                  long_word + " | " + long_word + " |\n" + long_word + "\n");
    std::string const exact = std::string(50, 'a') + " " + std::string(69, 'b');
    EXPECT_EQ(wrapped(exact + "\n"), exact + "\n") << "120 columns";
    EXPECT_EQ(wrapped(exact + "b\n"), exact.substr(0, 50) + "\n" + exact.substr(51) + "b\n");
}

TEST(Report, ALossIsMarked) {
    ReportOptions options;
    options.machines = {2, 5};
    std::string const page = report_page(figures(), options, {}, "framelet-bench report");
    EXPECT_NE(page.find("| `stop` | 0.50 framed+h264 | - | **2.00** framed+h264 |"), std::string::npos) << page;
    EXPECT_NE(page.find("Lost: 2 of 4. Median while something moves: 0.50."), std::string::npos) << page;
    EXPECT_NE(page.find("| + mirrors | 300 | 40 | 2.00 | 1.00 |"), std::string::npos) << page;
    EXPECT_EQ(page.find("## The real programs"), std::string::npos) << "none was run";
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

Goal goal_of(ReportFigures const& of, std::string const& what) {
    for (Goal const& goal : goals_of(of)) {
        if (goal.what == what) {
            return goal;
        }
    }
    ADD_FAILURE() << "there is no goal '" << what << "'";
    return {};
}

TEST(Goals, WhatWasNotMeasuredIsNotMet) {
    for (Goal const& goal : goals_of({})) {
        EXPECT_FALSE(goal.met) << goal.what;
        EXPECT_EQ(goal.figure, "not measured") << goal.what;
    }
    EXPECT_NE(goals_table({{"speed", "<= 1", "2", false}, {"height", ">= 1", "2", true}})
                  .find("| speed | <= 1 | 2 | no |\n| height | >= 1 | 2 | yes |\n"),
              std::string::npos);
}

TEST(Goals, LostCellsAreCountedScenesTimesMachines) {
    ReportFigures runs = figures();
    char const* const what = "virtual clock, no limit: MSE over the best rival's, scenes x machines";
    Goal const won = goal_of(runs, what);
    EXPECT_EQ(won.figure, "4 of 4; median 0.50, worst 0.50 (`globe, 2 samples`)");
    EXPECT_TRUE(won.met);
    runs.runs.back().mse = 6e-3; // `framelet` in globe on the fast machine
    Goal const lost = goal_of(runs, what);
    EXPECT_EQ(lost.figure, "3 of 4; median 0.50, worst 1.50 (`globe, 5 samples`)");
    EXPECT_FALSE(lost.met);
}

TEST(Goals, ThoseOfTheRealProgramsAreOfEveryScene) {
    ReportFigures runs;
    auto const scene = [](char const* name, double psnr) {
        nlohmann::json own = live_figures(psnr, 0.1), warp = live_figures(30, 0.1);
        own["photon_ms"] = 25;
        own["viewer_busy"] = 0.4;
        own["steadiness"] = 5e-4;
        return nlohmann::json{{"scene", name}, {"methods", {{"framed+warp", warp}, {"framelet", own}}}};
    };
    runs.live = {scene("stop", 33), scene("teleport", 33), scene("fox, flown", 33)};
    runs.narrow = {scene("stop, narrow link", 27)};
    EXPECT_EQ(goal_of(runs, "real programs, narrow links included: MSE over the best rival's").figure,
              "3 of 4; median 0.50, worst 2.00 (`stop, narrow link`)");
    EXPECT_TRUE(goal_of(runs, "MSE over the best rival's, median").met);
    EXPECT_TRUE(goal_of(runs, "1 - SSIM over the best rival's").met) << "as good is not worse";
    EXPECT_EQ(goal_of(runs, "motion to photon, display frames").figure, "4 of 4; median 1.5, worst 1.5 (`stop`)");
    EXPECT_EQ(goal_of(runs, "server busy, of what the viewer leaves of the machine").figure,
              "0 of 4; median 0.83, worst 0.83 (`stop`)");
    EXPECT_EQ(goal_of(runs, "unsteadiness over `framed+warp`'s, where something moves").figure,
              "3 of 3; median 0.50, worst 0.50 (`stop`)")
        << "teleport only jumps";
    EXPECT_EQ(goal_of(runs, "painting a changed pixel, ns of a core").figure, "not measured");
}

ReportRun over_link(char const* method, double bits, double mse) {
    return {"stop", method, 10, bits, 1e-5, mse, 0, 0, bits, {}};
}

TEST(Goals, BitsAreComparedWhereBothErrAlike) {
    std::vector<ReportRun> runs{over_link("framelet", 8, 1e-2), over_link("framelet", 32, 1e-4),
                                over_link("framed+warp", 4, 1e-2), over_link("framed+warp", 16, 1e-4)};
    EXPECT_NEAR(bits_at_equal_error(runs, "stop", "framed+warp"), 2, 1e-9) << "at 1e-3: 16 over 8";
    EXPECT_TRUE(std::isnan(bits_at_equal_error(runs, "stop", "tsar")));
    runs[0].mse = 1e-5; // now all of its errors are below all of the other's
    runs[1].mse = 1e-6;
    EXPECT_NEAR(bits_at_equal_error(runs, "stop", "framed+warp"), 0.5, 1e-9) << "8, at most, over 16, at least";
    runs[0].mse = runs[1].mse = 0.1; // now all of them are above
    EXPECT_TRUE(std::isinf(bits_at_equal_error(runs, "stop", "framed+warp")));
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
