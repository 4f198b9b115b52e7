#include "common/far_means.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(FarMeans, LargeHolesBesideGroundAreNotFilledWithSky) {
    constexpr int side = 8;
    FarMean const sky{100, 200, 300, 0};
    FarMean const ground{40, 30, 20, 0.1f};
    std::vector<FarMean> blocks(side * side, ground);
    std::fill_n(blocks.begin(), side * side / 2, sky);
    for (int const hole : {6 * side + 6, 6 * side + 7, 7 * side + 6, 7 * side + 7}) {
        blocks[static_cast<std::size_t>(hole)] = {};
    }
    FarMeans means;
    means.make(blocks, side, side);
    EXPECT_EQ(means.at(0, 0), sky);
    EXPECT_NEAR(means.at(7, 7).red, ground.red, 12);
    EXPECT_NEAR(means.at(7, 7).blue, ground.blue, 60);
    means.make(std::vector<FarMean>(side * side), side, side);
    EXPECT_EQ(means.at(3, 3), FarMean{});
}

} // namespace
} // namespace framelet
