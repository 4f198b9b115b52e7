#include "server/session/limits/log_limit.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

using namespace std::chrono_literals;

TEST(LogLimit, SaysOneAndCountsTheOthers) {
    LogLimit limit;
    WallTime const start{1000s};
    EXPECT_EQ(limit.next(start), "");
    for (int i = 0; i < 7; ++i) {
        EXPECT_EQ(limit.next(start + 9s), std::nullopt);
    }
    auto const behind = limit.next(start + 10s);
    ASSERT_TRUE(behind);
    EXPECT_NE(behind->find("7 more"), std::string::npos) << *behind;
    EXPECT_EQ(limit.next(start + 20s), "");
}

TEST(LogLimit, SaysSomeAndCountsTheOthers) {
    LogLimit limit(3);
    WallTime const start{1000s};
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(limit.next(start + i * 1s), "");
    }
    EXPECT_EQ(limit.next(start + 9s), std::nullopt);
    EXPECT_NE(limit.next(start + 10s).value_or("").find("1 more"), std::string::npos);
    EXPECT_EQ(limit.next(start + 11s), "");
}

} // namespace
} // namespace framelet
