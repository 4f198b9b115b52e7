// Tests the report's sums and page on figures with known answers.
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "tests/evaluation/report/report_charts.h"
#include "tests/evaluation/report/report_page.h"
#include "tests/evaluation/report/report_tables.h"
#include "tests/evaluation/report/report_text.h"
#include "tests/evaluation/report/run_store.h"

namespace framelet::bench {
namespace {

nlohmann::json live_figures(double psnr, double flip) {
    return {{"mse", std::pow(10, -0.1 * psnr)},
            {"psnr", psnr},
            {"psnr_low", psnr - 1},
            {"psnr_high", psnr + 1},
            {"ssim", 0.9},
            {"flip", flip},
            {"gap_p99_ms", 30},
            {"photon_ms", 25},
            {"pictures_per_second", 40},
            {"kB_per_second", 1200}};
}

/// A scene in which `framed+warp` has 30 dB.
nlohmann::json scene(char const* name, double psnr) {
    nlohmann::json warp = live_figures(30, 0.1);
    warp["spacing"] = 2;
    warp["margin"] = 0;
    warp["pictures_per_second"] = 20;
    return {{"scene", name},
            {"methods",
             {{"framed+h264", live_figures(20, 0.05)}, {"framed+warp", warp}, {"framelet", live_figures(psnr, 0.1)}}}};
}

ReportFigures figures() {
    ReportFigures result;
    result.commit = "abc";
    result.live = {scene("stop", 33), scene("fox, flown", 27)};
    result.lit = {scene("room", 33)};
    for (LinkCase const& link : link_cases({})) {
        result.links.push_back({link, scene("stop", link.round_trip > 100 ? 29 : 32)});
    }
    for (int const cores : {2, 8}) {
        result.cores.push_back({"stop", "framed+warp", cores, 1e-3});
        result.cores.push_back({"stop", "framed+h264", cores, 2e-3});
        result.cores.push_back({"stop", "framelet", cores, cores == 2 ? 5e-4 : 2e-3});
        result.cores.push_back({"globe", "framed+warp", cores, 1e-5});
        result.cores.push_back({"globe", "framelet", cores, 5e-6});
    }
    return result;
}

bool has_line(std::string const& text, std::string const& line) {
    return text.find(line + "\n") != std::string::npos;
}

TEST(Report, EachLinkIsRunOnce) {
    std::vector<LinkCase> const expected{{5, 20}, {20, 20}, {100, 20}, {20, 0}, {20, 200}};
    EXPECT_EQ(link_cases({}), expected);
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

TEST(Report, WhatIsLostIsInBold) {
    std::string const live = live_table(figures().live);
    EXPECT_TRUE(has_line(live, "| `stop` | `framed+warp` (2) | 33.0 / 30.0 | 32.0-34.0 / 29.0-31.0 | 0.900 / 0.900 | "
                               "0.100 / 0.100 | 40 / 20 | 30 / 30 | 1.2 / 1.2 |"))
        << live;
    EXPECT_NE(live.find("| **27.0 / 30.0** |"), std::string::npos) << live;
    std::string const links = links_table(figures().links);
    EXPECT_TRUE(has_line(links, "| `stop` | 20 | 0 | 32.0 | 30.0 | 20.0 |")) << links;
    EXPECT_TRUE(has_line(links, "| `stop` | 20 | 200 | **29.0** | 30.0 | 20.0 |")) << links;
    std::string const cores = cores_table(figures().cores);
    EXPECT_TRUE(has_line(cores, "| `stop` | 0.50 framed+warp | **2.00** framed+warp |")) << cores;
    EXPECT_TRUE(has_line(cores, "| `globe` | 0.50 framed+warp | 0.50 framed+warp |")) << cores;
}

TEST(Report, GoalsAreOfEveryScene) {
    std::string const goals = goals_table(figures());
    EXPECT_TRUE(has_line(goals,
                         "| real programs: MSE over the best rival's | <= 1 in each | 1 of 2; median 2.00, worst "
                         "2.00 (`fox, flown`) | no |"))
        << goals;
    EXPECT_TRUE(has_line(goals, "| 1 - SSIM over the best rival's | <= 1 in each | 2 of 2; median 1.00, worst 1.00 "
                                "(`stop`) | yes |"))
        << "as good is not worse\n"
        << goals;
    EXPECT_TRUE(has_line(goals, "| pictures a second | >= 30 in each | 2 of 2; median 40, worst 40 (`stop`) | yes |"))
        << goals;
    EXPECT_TRUE(has_line(goals, "| motion to photon, display frames | <= 2 in each | 2 of 2; median 1.5, worst 1.5 "
                                "(`stop`) | yes |"))
        << goals;
    EXPECT_TRUE(has_line(goals, "| full light: MSE over the best rival's | <= 1 in each | 1 of 1; median 0.50, worst "
                                "0.50 (`room`) | yes |"))
        << goals;
    EXPECT_TRUE(has_line(goals, "| over links: MSE over the best rival's | <= 1 in each | 4 of 5; median 0.63, worst "
                                "1.26 (`stop, 20 Mbit/s, 200 ms`) | no |"))
        << goals;
    EXPECT_TRUE(has_line(goals,
                         "| virtual clock: MSE over the best rival's | <= 1 in each | 3 of 4; median 0.50, worst "
                         "2.00 (`stop, 8 cores`) | no |"))
        << goals;
}

TEST(Report, WhatWasNotMeasuredIsNotMet) {
    std::string const goals = goals_table({});
    EXPECT_EQ(goals.find("| yes |"), std::string::npos) << goals;
    EXPECT_NE(goals.find("| not measured | no |"), std::string::npos);
    std::string const page = report_page({}, {}, {}, "framelet-bench report");
    EXPECT_EQ(page.find("## The real programs"), std::string::npos) << page;
}

TEST(Report, ChartsAreOfTheTablesFigures) {
    Arrows const live = live_chart(figures().live);
    ASSERT_EQ(live.arrows.size(), 2u);
    EXPECT_EQ(live.arrows[0].name, "stop");
    EXPECT_EQ(live.arrows[0].from, (std::array<double, 2>{20, 30}));
    EXPECT_EQ(live.arrows[0].to, (std::array<double, 2>{40, 33}));
    Panels const links = links_chart(figures().links, {});
    ASSERT_EQ(links.panels.size(), 2u) << "rates and round trips of one scene";
    EXPECT_EQ(links.panels[0].curves.size(), 3u);
    EXPECT_EQ(links.panels[0].curves[0].x, (std::vector<double>{5, 20, 100}));
    EXPECT_EQ(links.panels[1].curves[0].x, (std::vector<double>{0, 20, 200}));
    Curves const cores = cores_chart(figures().cores);
    ASSERT_EQ(cores.curves.size(), 3u);
    EXPECT_EQ(cores.curves[0].name, "framed+warp");
    EXPECT_EQ(cores.curves[0].x, (std::vector<double>{2, 8}));
    EXPECT_NEAR(cores.curves[0].y[0], 40, 1e-9) << "between 1e-3 and 1e-5";
}

TEST(RunStore, WhatACommitHasRunIsNotRunAgain) {
    auto const folder = std::filesystem::temp_directory_path() / ("framelet-report-" + std::to_string(getpid()));
    int runs = 0;
    auto const run = [&runs] { return nlohmann::json(++runs); };
    RunStore first(folder, "one", 2);
    EXPECT_EQ(first.get("a", run), 1);
    EXPECT_EQ(first.get("a", run), 1);
    RunStore again(folder, "one", 2);
    EXPECT_EQ(again.get("a", run), 1);
    std::ofstream(folder / "a.json") << "half of it";
    EXPECT_EQ(again.get("a", run), 2);
    RunStore other(folder, "two", 2);
    EXPECT_EQ(other.get("a", run), 3) << "a page is of one commit";
    std::filesystem::remove_all(folder);
}

} // namespace
} // namespace framelet::bench
