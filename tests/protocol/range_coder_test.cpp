#include "protocol/codec/entropy/range_coder.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "protocol/codec/entropy/adaptive_numbers.h"

namespace framelet {
namespace {

using Plain = std::vector<std::uint8_t>;

/// Random decisions, `count` of them, of which a share are yes.
std::vector<bool> decisions(std::size_t count, double share, std::mt19937& random) {
    std::vector<bool> all(count);
    for (std::size_t i = 0; i < count; ++i) {
        all[i] = std::bernoulli_distribution(share)(random);
    }
    return all;
}

Plain written(std::vector<bool> const& all) {
    RangeWriter writer;
    AdaptiveBit chance;
    for (bool const yes : all) {
        writer.bit(chance, yes);
    }
    auto const bytes = writer.finish();
    return {bytes.begin(), bytes.end()};
}

TEST(RangeCoder, DecisionsComeBackAndCostWhatTheyTell) {
    constexpr std::size_t count = 20000;
    std::mt19937 random(1);
    for (double const share : {0.0, 0.001, 0.02, 0.3, 0.5, 0.9, 0.999, 1.0}) {
        std::vector<bool> const all = decisions(count, share, random);
        Plain const bytes = written(all);
        RangeReader reader(bytes);
        AdaptiveBit chance;
        for (std::size_t i = 0; i < count; ++i) {
            ASSERT_EQ(reader.bit(chance), all[i]) << share << " decision " << i;
        }
        EXPECT_TRUE(reader.is_at_end());
        double const other = 1 - share;
        double const told = share > 0 && other > 0 ? -share * std::log2(share) - other * std::log2(other) : 0;
        EXPECT_LT(8.0 * static_cast<double>(bytes.size()), static_cast<double>(count) * (1.15 * told + 0.012)) << share;
    }
}

/// Sequences are of all lengths, so that every end comes up, and with chances that make carries run over many bytes.
TEST(RangeCoder, EndsAndCarriesAreRight) {
    std::mt19937 random(2);
    for (int round = 0; round < 20000; ++round) {
        std::size_t const count = random() % 120;
        double const share = static_cast<double>(random() % 101) / 100;
        std::vector<bool> const all = decisions(count, share, random);
        RangeWriter writer;
        std::array<AdaptiveBit, 3> chances;
        for (std::size_t i = 0; i < count; ++i) {
            i % 5 == 4 ? writer.even_bit(all[i]) : writer.bit(chances[i % 3], all[i]);
        }
        auto const bytes = writer.finish();
        ASSERT_TRUE(bytes.empty() || bytes.back() != 0);
        RangeReader reader(bytes);
        chances = {};
        for (std::size_t i = 0; i < count; ++i) {
            ASSERT_EQ(i % 5 == 4 ? reader.even_bit() : reader.bit(chances[i % 3]), all[i]) << round;
        }
        ASSERT_TRUE(reader.is_at_end());
    }
}

TEST(RangeCoder, NothingTakesNoBytesAndAWriterIsUsedAgain) {
    EXPECT_TRUE(written({}).empty());
    RangeWriter writer;
    Plain first;
    for (int i = 0; i < 3; ++i) {
        writer.begin();
        AdaptiveBit chance;
        for (int k = 0; k < 1000; ++k) {
            writer.bit(chance, k % 7 == 0);
        }
        auto const bytes = writer.finish();
        first = i == 0 ? Plain(bytes.begin(), bytes.end()) : first;
        EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), first.begin(), first.end()));
    }
}

TEST(RangeCoder, AChanceIsNeverNoneAndNeverAll) {
    for (bool const yes : {false, true}) {
        AdaptiveBit chance;
        for (int i = 0; i < 100000; ++i) {
            chance.learn(yes);
            ASSERT_GT(chance.chance(), 0u);
            ASSERT_LT(chance.chance(), 1u << range_coding::chance_bits);
        }
    }
}

TEST(AdaptiveNumbers, AllOfThemComeBack) {
    AdaptiveSize<3> writing_sizes, reading_sizes;
    AdaptiveNumber<5> writing_numbers, reading_numbers;
    AdaptiveTree<7> writing_tree, reading_tree;
    RangeWriter writer;
    for (int i = 0; i < 65536; ++i) {
        writing_sizes.code(writer, static_cast<std::uint32_t>(i + 3));
        writing_numbers.code(writer, static_cast<std::int16_t>(i - 32768));
        writing_tree.code(writer, static_cast<unsigned>(i % 128));
    }
    auto const bytes = writer.finish();
    RangeReader reader(bytes);
    for (int i = 0; i < 65536; ++i) {
        ASSERT_EQ(reading_sizes.code(reader, 0), static_cast<std::uint32_t>(i + 3));
        ASSERT_EQ(reading_numbers.code(reader, 0), static_cast<std::int16_t>(i - 32768));
        ASSERT_EQ(reading_tree.code(reader, 0), static_cast<unsigned>(i % 128));
    }
    EXPECT_TRUE(reader.is_at_end());
}

TEST(AdaptiveNumbers, TooLargeOnesAreRefused) {
    RangeWriter writer;
    std::array<AdaptiveBit, 4> chances; // those of a size whose length never ends
    for (int i = 0; i < 100; ++i) {
        writer.bit(chances[0], true);
    }
    auto const bytes = writer.finish();
    RangeReader reader(bytes);
    AdaptiveSize<3> sizes;
    EXPECT_THROW(
        {
            for (int i = 0; i < 100; ++i) {
                sizes.code(reader, 0);
            }
        },
        ProtocolError);
}

TEST(RangeCoder, AnyBytesAreRead) {
    std::mt19937 random(3);
    for (int round = 0; round < 2000; ++round) {
        Plain bytes(random() % 40);
        for (std::uint8_t& byte : bytes) {
            byte = static_cast<std::uint8_t>(random());
        }
        Plain longer = bytes;
        longer.resize(bytes.size() + 2000);
        RangeReader reader(bytes), other(longer);
        std::array<AdaptiveBit, 8> chances, others;
        for (std::size_t i = 0; i < 1000; ++i) {
            ASSERT_EQ(reader.bit(chances[i % 8]), other.bit(others[i % 8])) << "behind the bytes there are zeros";
        }
    }
}

} // namespace
} // namespace framelet
