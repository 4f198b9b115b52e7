#include "tests/evaluation/soak/process_watch.h"

#include <algorithm>
#include <cmath>
#include <random>
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

TEST(Growth, OfKnownPairs) {
    // The differences are 1, 3, 2: their mean is 2, their deviation 1.
    std::vector<double> const before{10, 50, 30}, after{11, 53, 32};
    Growth const growth = growth_of(before, after);
    EXPECT_NEAR(growth.mean, 2, 1e-12);
    EXPECT_NEAR(growth.error, 1 / std::sqrt(3.0), 1e-12);
    EXPECT_NEAR(growth.before, 30, 1e-12);
    EXPECT_EQ(growth.pairs, 3u);
}

TEST(Growth, IsToldFromNoiseAndFromWhatEachStormLeaves) {
    std::vector<double> before, still, leaking;
    for (int i = 0; i < 50; ++i) {
        double const noise = i % 3 - 1, storm = 20 * std::sin(i);
        before.push_back(100 + storm);
        still.push_back(100 + storm + noise);
        leaking.push_back(105 + storm + noise);
    }
    EXPECT_FALSE(grows(growth_of(before, still), 0.02));
    EXPECT_TRUE(grows(growth_of(before, leaking), 0.02)) << "though storms differ by more than that";
    EXPECT_FALSE(grows(growth_of(before, leaking), 0.2)) << "it is a twentieth";
    EXPECT_FALSE(grows(growth_of(leaking, before), 0.02));
    std::vector<double> const few_before{100, 100, 100, 100, 100}, few{104, 103, 109, 102, 112};
    EXPECT_GT(growth_of(few_before, few).mean, 3 * growth_of(few_before, few).error);
    EXPECT_FALSE(grows(growth_of(few_before, few), 0.02)) << "as few pairs do by chance";
}

TEST(Growth, ByChanceIsSeldom) {
    std::mt19937 random(1);
    std::normal_distribution<double> noise(100, 10);
    for (std::size_t const pairs : {5u, 12u, 60u}) {
        int alarms = 0;
        std::vector<double> before(pairs), after(pairs);
        for (int i = 0; i < 100000; ++i) {
            std::ranges::generate(before, [&] { return noise(random); });
            std::ranges::generate(after, [&] { return noise(random); });
            alarms += grows(growth_of(before, after), 0) ? 1 : 0;
        }
        EXPECT_LT(alarms, 150) << pairs << " pairs, of 100000: 100 are expected";
        EXPECT_GT(alarms, 50) << pairs;
    }
}

} // namespace
} // namespace framelet::bench
