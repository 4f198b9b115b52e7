#include "common/picture/far_means.h"

#include <algorithm>
#include <random>

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

/// Cells that are computed eight at a time are what each is alone.
TEST(FarGrid, EachCellIsTheMeanOfTheFarthestOfItsFour) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> depth(0, 1), byte(0, 255 * 255);
    FarGrid<16> fine;
    for (std::size_t i = 0; i < FarGrid<16>::cells; ++i) {
        bool const nothing = random() % 3 == 0;
        put(nothing ? FarMean{} : FarMean{byte(random), byte(random), byte(random), depth(random)}, i, fine);
    }
    FarGrid<8> coarse;
    pull(fine, coarse);
    for (std::size_t y = 0; y < 8; ++y) {
        for (std::size_t x = 0; x < 8; ++x) {
            std::size_t const i = 32 * y + 2 * x;
            auto const& w = fine.inverse_depth;
            FarthestOfFour<float> const four({1, 1, 1, 1}, w[i], w[i + 1], w[i + 16], w[i + 17]);
            FarMean const mean = mean_at(coarse, 8 * y + x);
            EXPECT_EQ(mean.inverse_depth, std::min({w[i], w[i + 1], w[i + 16], w[i + 17]}));
            auto const& green = fine.green;
            EXPECT_NEAR(mean.green, four.mean(green[i], green[i + 1], green[i + 16], green[i + 17]), 0.05f);
        }
    }
}

} // namespace
} // namespace framelet
