#include "tests/evaluation/charts/charts.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>
#include <unistd.h>

#include <gtest/gtest.h>

#include "common/error.h"
#include "common/files/image_io.h"
#include "tests/evaluation/charts/chart_style.h"

namespace framelet::bench {
namespace {

namespace fs = std::filesystem;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Checks charts by gnuplot's own idea of right: the files are there, the drawing has ink in it, its texts are in the
/// SVG.
class ChartFile : public testing::Test {
protected:
    ~ChartFile() override { fs::remove_all(folder_); }

    std::string svg(fs::path const& stem) const {
        std::ifstream stream(stem.string() + ".svg");
        std::ostringstream text;
        text << stream.rdbuf();
        return text.str();
    }

    template <class Chart>
    std::string drawn(Chart const& chart) {
        fs::path const stem = folder_ / "chart v1.5"; // the name has a dot and a blank
        draw(chart, stem);
        Picture const png = read_picture(stem.string() + ".png");
        Plot const plot = plot_of(chart);
        EXPECT_EQ(png.width, plot.width);
        EXPECT_EQ(png.height, plot.height);
        std::set<std::uint8_t> const levels(png.rgba.begin(), png.rgba.end());
        EXPECT_GT(levels.size(), 20u);
        EXPECT_EQ(png.rgba[0], 255);
        return svg(stem);
    }

    fs::path const folder_ = fs::path(testing::TempDir()) / ("framelet_charts_test_" + std::to_string(getpid()));
};

void expect_has(std::string const& text, std::string const& part) {
    EXPECT_NE(text.find(part), std::string::npos) << "no '" << part << "' in:\n" << text.substr(0, 3000);
}

TEST_F(ChartFile, ErrorOverTime) {
    ErrorOverTime const chart{.title = "Scene 'x' at {5} Mbit/s",
                              .series = {{"framed_a", {0, 1, 2, 3}, {1e-3, 2e-3, 1e-3, 0}, {0, 2}},
                                         {"framelet", {0, 1, 2, 3}, {1e-4, NAN, 2e-5, 1e-5}, {}}}};
    std::string const text = drawn(chart);
    expect_has(text, "Scene 'x' at {5} Mbit/s");
    expect_has(text, "framed_a");
    expect_has(text, "time [s]");
    expect_has(text, "refreshes");

    std::string const data = plot_of(chart).data;
    expect_has(data, "$curve1 << EOD\n0 1e-04\n\n2 2e-05\n3 1e-05\nEOD\n"); // a gap where there is no value
    expect_has(data, "$refresh0 << EOD\n0 ");
    EXPECT_EQ(data.find("$refresh1"), std::string::npos);
}

TEST_F(ChartFile, Curves) {
    Curves chart{"t", "link [Mbit/s]", "PSNR [dB]", true, false, {{"tsar", {1, 10, 100}, {20, 25, 30}}}};
    std::string const text = drawn(chart);
    expect_has(text, "link [Mbit/s]");
    expect_has(text, ">100<"); // this is a mark of the axis
    chart.log_x = false;
    chart.curves[0].y = {0, 0, 0};
    drawn(chart);
}

TEST_F(ChartFile, Panels) {
    Curves const one{"first", "x", "y", true, false, {{"tsar", {1, 10}, {20, 25}}, {"afr", {1, 10}, {2, 2}}}};
    Curves two = one;
    two.title = "second";
    two.curves[0].y = {7, 8};
    Panels const chart{2, {one, two}};
    std::string const text = drawn(chart);
    expect_has(text, "first");
    expect_has(text, "second");
    expect_has(plot_of(chart).data, "$curve2 << EOD\n1 7\n10 8\nEOD\n"); // numbers go on from panel to panel
}

TEST_F(ChartFile, ArrowsHaveNamesAtTheirHeads) {
    Arrows const chart{"t", "x", "y", {{"wind_mill, flown", {1, 2}, {4, 8}}}};
    expect_has(drawn(chart), "wind_mill, flown");
    expect_has(plot_of(chart).data, "1 2 3 6 4 8 \"wind_mill, flown\"\n"); // from, how far, to
}

TEST(Charts, BadInputIsRefused) {
    Curves chart{"t", "x", "y", false, false, {}};
    EXPECT_THROW(plot_of(chart), InputError);
    chart.curves = {{"a", {1, 2}, {1}}};
    EXPECT_THROW(plot_of(chart), InputError);
    chart.curves = {{"a", {1, NAN}, {NAN, 1}}};
    EXPECT_THROW(plot_of(chart), InputError);
    EXPECT_THROW(plot_of(ErrorOverTime{}), InputError);
    EXPECT_THROW(plot_of(Panels{}), InputError);
    EXPECT_THROW(plot_of(Arrows{}), InputError);
}

TEST(ChartStyle, EveryMethodHasItsOwnLook) {
    std::set<std::string> looks;
    for (char const* const name : {"framed", "framed+h264", "framed+warp", "interruptible", "frameless", "afr", "tsar",
                                   "framelet-unwarped", "framelet"}) {
        EXPECT_TRUE(looks.insert(to_string(style_of(name))).second) << name;
    }
    EXPECT_TRUE(looks.insert(to_string(style_of("another"))).second);
}

TEST(ChartStyle, LogarithmicAxes) {
    Range const wide = log_range(std::vector<double>{1e-5, NAN, 3, infinity});
    EXPECT_EQ(wide.low, 1e-5);
    EXPECT_EQ(wide.high, 3);
    Range const with_zero = log_range(std::vector<double>{0, 1, 100});
    EXPECT_EQ(with_zero.low, 0.5);
    EXPECT_EQ(on_log_axis(0, with_zero), 0.5);
    EXPECT_EQ(on_log_axis(infinity, with_zero), 100);
    Range const one = log_range(std::vector<double>{3, 3});
    EXPECT_NEAR(one.high / one.low, 4, 1e-12);
    EXPECT_NEAR(one.high * one.low, 9, 1e-12);
    Range const none = log_range(std::vector<double>{0, -2});
    EXPECT_LT(none.low, none.high);

    expect_has(log_axis("y", {0.9, 8}, 0.9, 8), "('' 0.9 1, '1' 1 0, '2' 2 0, '' 3 1, '' 4 1, '5' 5 0,");
    std::string const powers = log_axis("x", {1e-6, 1}, 1e-6, 1);
    expect_has(powers, "'10^{-6}' 1e-06 0");
    expect_has(powers, "'0.01' 0.01 0");
    EXPECT_EQ(log_axis("y", {0.1, 100}, 0.1, 10).find("100 0"), std::string::npos);
}

TEST(Gnuplot, TextIsTakenLiterally) {
    EXPECT_EQ(quoted("it's\na \"test\" `x`"), "'it''s a \"test\" `x`'");
    EXPECT_EQ(number(0.1), "0.1");
    EXPECT_EQ(number(-2e-7), "-2e-07");
}

std::string failure_of(std::string const& script) {
    try {
        run_gnuplot(script);
    } catch (InputError const& error) {
        return error.what();
    }
    return "";
}

TEST(Gnuplot, AFailingScriptSaysWhere) {
    EXPECT_EQ(failure_of("set title 'fine'\n"), "");
    std::string const failure = failure_of("set title 'fine'\nplot nonsense(x)\n");
    expect_has(failure, "gnuplot failed: line 2: undefined function: nonsense");
    EXPECT_EQ(failure.find('\n'), std::string::npos);
}

TEST(Gnuplot, FilesThatCannotBeWrittenAreNamed) {
    try {
        render({"", "plot x\n"}, "/dev/null/chart");
        FAIL();
    } catch (InputError const& error) {
        EXPECT_STREQ(error.what(), "cannot write '/dev/null/chart.svg'");
    }
}

TEST(Gnuplot, WithoutGnuplotTheMessageSaysWhatToInstall) {
    std::string const path = std::getenv("PATH");
    ASSERT_EQ(setenv("PATH", "/nowhere", 1), 0);
    std::string const failure = failure_of("set title 'fine'\n");
    ASSERT_EQ(setenv("PATH", path.c_str(), 1), 0);
    expect_has(failure, "gnuplot-nox");
}

} // namespace
} // namespace framelet::bench
