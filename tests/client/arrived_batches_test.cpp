#include "client/core/session/arrived_batches.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

Batch batch_of(std::uint64_t number, std::size_t framelets) {
    Batch batch;
    batch.number = number;
    batch.framelets.resize(framelets);
    return batch;
}

TEST(ArrivedBatches, AreTakenInOrderAndCounted) {
    ArrivedBatches arrived;
    EXPECT_TRUE(arrived.empty());
    arrived.add(batch_of(1, 3));
    std::size_t const one = arrived.bytes();
    EXPECT_GE(one, 3 * sizeof(DisplayFramelet));
    arrived.add(batch_of(2, 3));
    EXPECT_EQ(arrived.bytes(), 2 * one);
    std::vector<Batch> taken;
    arrived.take(taken);
    ASSERT_EQ(taken.size(), 2u);
    EXPECT_EQ(taken[0].number, 1u);
    EXPECT_EQ(taken[1].number, 2u);
    EXPECT_TRUE(arrived.empty());
    EXPECT_EQ(arrived.bytes(), 0u);
}

TEST(ArrivedBatches, AreTooManyByTheirBytes) {
    ArrivedBatches arrived;
    std::size_t const half = ArrivedBatches::most_bytes / sizeof(DisplayFramelet) / 2;
    arrived.add(batch_of(1, half));
    EXPECT_FALSE(arrived.is_full());
    arrived.add(batch_of(2, half + 1));
    EXPECT_TRUE(arrived.is_full());
    arrived.clear();
    EXPECT_FALSE(arrived.is_full());
    EXPECT_TRUE(arrived.empty());
}

TEST(ArrivedBatches, MemoryOfAFewIsUsedAgain) {
    ArrivedBatches arrived;
    std::vector<Batch> used;
    for (std::uint64_t i = 0; i < ArrivedBatches::most_spares + 2; ++i) {
        used.push_back(batch_of(i, 100));
    }
    arrived.give_back(used);
    EXPECT_TRUE(used.empty());
    for (std::size_t i = 0; i < ArrivedBatches::most_spares; ++i) {
        EXPECT_GE(arrived.take_spare().framelets.capacity(), 100u);
    }
    EXPECT_EQ(arrived.take_spare().framelets.capacity(), 0u);
}

} // namespace
} // namespace framelet
