#include "tests/evaluation/methods/response/depth_first_order.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(DepthFirstOrder, KnownNumbers) {
    constexpr int max_depth = 6;
    std::vector<std::pair<std::uint32_t, std::uint64_t>> const known{
        {1, 1}, {2, 2}, {3, 65}, {4, 3}, {5, 34}, {6, 66}, {7, 97}, {10, 35}, {20, 36}, {21, 43}, {127, 127}};
    for (auto const& [index, number] : known) {
        EXPECT_EQ(depth_first_index(index, max_depth), number) << index;
    }
    EXPECT_EQ(subtree_size(1, max_depth), 127u);
    EXPECT_EQ(subtree_size(4, max_depth), 31u);
    EXPECT_EQ(subtree_size(20, max_depth), 7u);
    EXPECT_EQ(subtree_size(64, max_depth), 1u);
}

TEST(DepthFirstOrder, TheTilingOfThePaper) {
    // The tiles of eq. 4.9 in the order of eq. 4.14.
    std::vector<std::uint32_t> const tiles{4, 20, 21, 88, 89, 90, 91, 23, 24, 25, 26, 27, 7};
    std::vector<std::uint64_t> const numbers{3, 36, 43, 53, 54, 56, 57, 58, 68, 75, 83, 90, 97};
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        EXPECT_EQ(depth_first_index(Tile{tiles[i]}, 3), numbers[i]) << tiles[i];
    }
}

TEST(DepthFirstOrder, NumbersACompleteTreeWithoutGaps) {
    constexpr int max_depth = 12;
    std::vector<std::uint64_t> numbers;
    for (std::uint32_t index = 1; index < 1u << (max_depth + 1); ++index) {
        numbers.push_back(depth_first_index(index, max_depth));
    }
    std::sort(numbers.begin(), numbers.end());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        ASSERT_EQ(numbers[i], i + 1);
    }
}

TEST(DepthFirstOrder, DescendantsLieBetweenATileAndItsSuccessor) {
    constexpr int max_depth = 6;
    for (std::uint32_t tile = 1; tile < 64; ++tile) {
        int const depth = Tile{tile}.depth();
        if (!is_tile_code(tile) || depth == 0) {
            continue;
        }
        for (std::uint32_t d = tile << 2; d < (tile + 1) << 2; ++d) {
            std::uint64_t const from = depth_first_index(Tile{tile}, max_depth);
            std::uint64_t const number = depth_first_index(Tile{d}, max_depth);
            EXPECT_GT(number, from);
            EXPECT_LT(number, from + subtree_size(tile, 2 * max_depth));
        }
    }
}

} // namespace
} // namespace framelet
