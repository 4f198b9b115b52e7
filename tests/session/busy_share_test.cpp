#include "server/session/figures/busy_share.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(BusyShare, IsOfTheTimeSinceTheFigureBefore) {
    using namespace std::chrono_literals;
    auto const start = std::chrono::steady_clock::now() + 10s;
    BusyShare share;
    share.update(0, start);
    EXPECT_FLOAT_EQ(share.update(0.75, start + 1s), 0.75f);
    EXPECT_FLOAT_EQ(share.update(0.85, start + 1100ms), 0.75f); // too early for another
    EXPECT_FLOAT_EQ(share.update(1, start + 2s), 0.25f);
    EXPECT_FLOAT_EQ(share.update(1, start + 3s), 0);
    EXPECT_FLOAT_EQ(share.update(9, start + 4s), 1); // a turn that began long before counts when it is over
    EXPECT_FLOAT_EQ(share.update(0, start + 5s), 0);
}

} // namespace
} // namespace framelet
