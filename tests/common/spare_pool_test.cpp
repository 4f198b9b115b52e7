#include "common/spare_pool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

namespace framelet {
namespace {

using Names = std::vector<std::pair<std::uint64_t, std::uint32_t>>;

Names sorted_names(std::span<Spare const> spares) {
    Names out;
    for (Spare const& spare : spares) {
        out.emplace_back(spare.batch, spare.tile.code);
    }
    std::ranges::sort(out);
    return out;
}

TEST(SparePool, NeverHoldsMoreThanItMayAndGivesBackTheRest) {
    constexpr std::size_t most = 300;
    SparePool pool(most);
    std::mt19937 random(1);
    std::size_t const bytes = pool.memory_bytes();
    std::size_t gone = 0;
    for (std::int32_t i = 0; i < 1'000'000; ++i) {
        gone += pool.add({random() % 1000, {1 + static_cast<std::uint32_t>(random() % 5000)}, i}) ? 1 : 0;
        ASSERT_LE(pool.all().size(), most);
        ASSERT_EQ(pool.all().size() + gone, static_cast<std::size_t>(i) + 1);
    }
    EXPECT_EQ(pool.memory_bytes(), bytes);
}

TEST(SparePool, HoldsTheNewestWhateverTheOrder) {
    constexpr std::size_t most = 50;
    std::vector<Spare> spares;
    for (std::uint64_t batch = 1; batch <= 40; ++batch) {
        for (std::uint32_t code = 16; code < 16 + batch % 7; ++code) {
            spares.push_back({batch, {code}, static_cast<std::int32_t>(spares.size())});
        }
    }
    Names const newest = sorted_names(std::span(spares).last(most));
    std::mt19937 random(2);
    for (int order = 0; order < 20; ++order) {
        SparePool pool(most);
        for (Spare const& spare : spares) {
            pool.add(spare);
        }
        EXPECT_EQ(sorted_names(pool.all()), newest);
        std::shuffle(spares.begin(), spares.end(), random);
    }
}

TEST(SparePool, OfNoSizeGivesBackEverything) {
    SparePool pool(0);
    auto const gone = pool.add({3, {17}, 5});
    ASSERT_TRUE(gone);
    EXPECT_EQ(gone->slot, 5);
    EXPECT_TRUE(pool.all().empty());
}

} // namespace
} // namespace framelet
