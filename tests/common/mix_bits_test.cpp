#include "common/mix_bits.h"

#include <bit>
#include <set>

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(MixBits, KnownValues) {
    static_assert(mix_in(0, 0) == 0);
    static_assert(mix_in(0, 1) == (0x9e3779b97f4a7c15u ^ 0x9e3779b9u));
    static_assert(mix_in(1, 0) == mix_in(0, 1));
    static_assert(mix_bits(0) == 0);
    EXPECT_EQ(mix_in(mix_in(1, 2), 3), 0xc851bec85be37098u);
    EXPECT_EQ(mix_bits(1), 0x86d2fa73u);
}

TEST(MixBits, TheOrderOfWordsCounts) {
    EXPECT_NE(mix_in(mix_in(1, 2), 3), mix_in(mix_in(1, 3), 2));
}

TEST(MixBits, SmallNumbersGoApart) {
    std::set<std::uint64_t> fingerprints;
    std::set<std::uint32_t> numbers;
    for (std::uint32_t a = 0; a < 64; ++a) {
        for (std::uint32_t b = 0; b < 64; ++b) {
            fingerprints.insert(mix_in(mix_in(1, a), b));
            numbers.insert(mix_bits(64 * a + b));
        }
    }
    EXPECT_EQ(fingerprints.size(), 4096u);
    EXPECT_EQ(numbers.size(), 4096u);
}

TEST(MixBits, EachBitTurnsAboutHalfOfTheBits) {
    for (int bit = 0; bit < 32; ++bit) {
        int turned = 0;
        for (std::uint32_t x = 0; x < 1000; ++x) {
            turned += std::popcount(mix_bits(x) ^ mix_bits(x ^ 1u << bit));
        }
        EXPECT_NEAR(turned / 1000.0, 16, 1) << bit;
    }
}

} // namespace
} // namespace framelet
