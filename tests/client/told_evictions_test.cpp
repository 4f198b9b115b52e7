#include "client/core/session/told_evictions.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

Evicted message_of(std::size_t framelets) {
    return {std::vector<SentTile>(framelets)};
}

TEST(ToldEvictions, WhatHasNotComeIsKeptInOrder) {
    ToldEvictions told;
    for (std::size_t framelets = 1; framelets <= 4; ++framelets) {
        told.keep(message_of(framelets));
    }
    told.note_come(2);
    ASSERT_EQ(told.messages().size(), 2u);
    EXPECT_EQ(told.messages().front().framelets.size(), 3u);
    told.note_come(1);
    EXPECT_EQ(told.messages().size(), 2u) << "what an older message says";
    told.note_come(UINT64_MAX);
    EXPECT_TRUE(told.messages().empty());
    told.keep(message_of(5));
    EXPECT_EQ(told.messages().size(), 1u);
}

TEST(ToldEvictions, OfTooManyNothingIsKept) {
    ToldEvictions told;
    told.keep(message_of(ToldEvictions::most_framelets));
    EXPECT_FALSE(told.is_lost());
    told.note_come(1);
    told.keep(message_of(ToldEvictions::most_framelets));
    EXPECT_FALSE(told.is_lost());
    told.keep(message_of(1));
    EXPECT_TRUE(told.is_lost());
    EXPECT_TRUE(told.messages().empty());
    told.keep(message_of(1));
    told.note_come(9);
    EXPECT_TRUE(told.is_lost());
    EXPECT_TRUE(told.messages().empty());
}

} // namespace
} // namespace framelet
