#include "common/picture/mix_shares.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(MixAmount, RunsFromTheOlderTimeToTheNewerOneWhicheverWayTheClockRuns) {
    EXPECT_EQ(mix_amount(2, 3, 2, 10), 0);
    EXPECT_EQ(mix_amount(2, 3, 3, 10), 1);
    EXPECT_NEAR(*mix_amount(2, 3, 2.25, 10), 0.25, 1e-12);
    EXPECT_EQ(mix_amount(2, 3, 1, 10), 0);
    EXPECT_EQ(mix_amount(2, 3, 9, 10), 1);
    EXPECT_NEAR(*mix_amount(3, 2, 2.25, 10), 0.75, 1e-12);
    EXPECT_EQ(mix_amount(9, 2, 2, 10), 1) << "the clock was set back";
}

TEST(MixAmount, AChangeTakesNoLongerThanItMay) {
    EXPECT_EQ(mix_amount(0, 5, 4.875, 0.125), 0);
    EXPECT_NEAR(*mix_amount(0, 5, 4.9375, 0.125), 0.5, 1e-12);
    EXPECT_EQ(mix_amount(0, 5, 5, 0.125), 1);
    EXPECT_EQ(mix_amount(0, 5, 4.99, 0), 1);
}

TEST(MixAmount, WithoutAnythingOlderTheNewerShows) {
    EXPECT_EQ(mix_amount(std::nullopt, 2, 0, 1), 1);
    EXPECT_EQ(mix_amount(std::nullopt, std::nullopt, 0, 1), 1);
    EXPECT_EQ(mix_amount(2, std::nullopt, 0, 1), 1);
    EXPECT_EQ(mix_amount(2, 2, 0, 1), std::nullopt);
}

TEST(MixShares, BlocksThatDoNotChangeFollowThoseAroundThem) {
    // Two blocks change, far apart in a row of eight; in the last one nothing is older.
    ShownTimes older(16, 0.0), newer(16, 0.0);
    newer[8] = 1;
    newer[13] = 2;
    older[15] = std::nullopt;
    std::vector<MixShare> shares;
    mix_shares(older, newer, 8, 0.5, 10, shares);
    MixShare const mean = (128 + 64 + whole_share + 1) / 3;
    EXPECT_EQ(shares, (std::vector<MixShare>{128, 128, mean, mean, 64, 64, 160, 256, // the row above
                                             128, 128, mean, mean, 64, 64, 160, 256}));
}

TEST(MixShares, WhereNothingChangesTheNewerShows) {
    std::vector<MixShare> shares;
    mix_shares(ShownTimes(6, 1.0), ShownTimes(6, 1.0), 3, 0.5, 1, shares);
    EXPECT_EQ(shares, std::vector<MixShare>(6, whole_share));
}

} // namespace
} // namespace framelet
