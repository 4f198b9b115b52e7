#include "tests/evaluation/soak/process_watch.h"

#include <cmath>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace framelet::bench {
namespace {

TEST(ProcessWatch, CountsDescriptorsAndMemory) {
    ProcessHoldings const before = holdings_of(::getpid());
    int const file = ::open("/dev/null", O_RDONLY);
    constexpr std::size_t bytes = 64 << 20;
    std::vector<char> const memory(bytes, 'x');
    ProcessHoldings const after = holdings_of(::getpid());
    ::close(file);
    EXPECT_EQ(after.descriptors, before.descriptors + 1);
    EXPECT_NEAR(after.resident_bytes - before.resident_bytes, static_cast<double>(memory.size()), 4e6);
    EXPECT_EQ(holdings_of(::getpid()).descriptors, before.descriptors);
}

TEST(ProcessWatch, NobodyHoldsNothing) {
    ProcessHoldings const held = holdings_of(-1);
    EXPECT_EQ(held.descriptors, 0u);
    EXPECT_EQ(held.resident_bytes, 0);
}

TEST(Trend, OfPointsOnALine) {
    std::vector<double> const times{1, 2, 4, 8}, values{5, 7, 11, 19};
    Trend const trend = trend_of(times, values);
    EXPECT_NEAR(trend.slope, 2, 1e-12);
    EXPECT_NEAR(trend.slope_error, 0, 1e-12);
    EXPECT_EQ(trend.mean, 10.5);
}

TEST(Trend, StandardErrorOfKnownPoints) {
    // About the line 1.3 + 0.8 t they are off by -0.3, 0.9, -0.9, 0.3: squares of 1.8 together, those of the times 5.
    std::vector<double> const times{0, 1, 2, 3}, values{1, 3, 2, 4};
    Trend const trend = trend_of(times, values);
    EXPECT_NEAR(trend.slope, 0.8, 1e-12);
    EXPECT_NEAR(trend.slope_error, std::sqrt(1.8 / 2 / 5), 1e-12);
}

TEST(Trend, GrowthIsToldFromNoise) {
    std::vector<double> times, still, leaking;
    for (int i = 0; i < 100; ++i) {
        double const noise = i % 3 - 1;
        times.push_back(i);
        still.push_back(100 + noise);
        leaking.push_back(100 + noise + 0.1 * i);
    }
    EXPECT_FALSE(grows(trend_of(times, still), 100, 0.02));
    EXPECT_TRUE(grows(trend_of(times, leaking), 100, 0.02));
    EXPECT_FALSE(grows(trend_of(times, leaking), 100, 0.2)) << "it is a tenth";
    std::vector<double> const few_times{0, 10, 20, 30, 40, 50}, few{100, 103, 101, 105, 104, 108};
    EXPECT_GT(trend_of(few_times, few).slope, 3 * trend_of(few_times, few).slope_error);
    EXPECT_FALSE(grows(trend_of(few_times, few), 50, 0.02)) << "as few points do by chance";
    for (double& value : leaking) {
        value = -value;
    }
    EXPECT_FALSE(grows(trend_of(times, leaking), 100, 0.02));
}

} // namespace
} // namespace framelet::bench
