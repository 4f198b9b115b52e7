#include "common/simd/lane_bits.h"

#include <random>
#include <set>

#include <gtest/gtest.h>

namespace framelet {
namespace {

constexpr std::size_t count = 192;
using Bits = LaneBits<count>;

std::set<std::size_t> members(Bits const& bits) {
    std::set<std::size_t> out;
    bits.for_each([&](std::size_t number) { EXPECT_TRUE(out.insert(number).second); });
    return out;
}

TEST(LaneBits, AreSets) {
    std::mt19937 random(3);
    for (int round = 0; round < 300; ++round) {
        std::size_t const size = random() % (count + 1);
        Bits a = Bits::first(size), b;
        std::set<std::size_t> in_a, in_b;
        for (std::size_t i = 0; i < size; ++i) {
            in_a.insert(i);
        }
        EXPECT_EQ(members(a), in_a);
        for (auto left = random() % 40; left > 0; --left) {
            std::size_t const number = random() % count;
            b = b | Bits::only(number);
            in_b.insert(number);
        }
        EXPECT_EQ(members(b), in_b);
        EXPECT_EQ(a.any(), !in_a.empty());
        if (b.any()) {
            EXPECT_EQ(b.lowest(), *in_b.begin());
        }
        for (std::size_t i = 0; i < count; ++i) {
            bool const is_a = in_a.contains(i), is_b = in_b.contains(i);
            Bits const one = Bits::only(i);
            EXPECT_EQ((one & (a | b)).any(), is_a || is_b);
            EXPECT_EQ((one & (a & b)).any(), is_a && is_b);
            EXPECT_EQ((one & a.without(b)).any(), is_a && !is_b);
        }
    }
}

TEST(LaneBits, LanesAreTheBitsFromThere) {
    std::mt19937 random(4);
    Bits bits;
    for (std::size_t i = 0; i < count; i += wide_doubles) {
        unsigned const lanes = static_cast<unsigned>(random()) & ((1u << wide_doubles) - 1);
        bits.add_lanes(i, lanes);
        EXPECT_EQ(bits.lanes(i), lanes);
        for (std::size_t k = 0; k < wide_doubles; ++k) {
            EXPECT_EQ((bits & Bits::only(i + k)).any(), (lanes >> k & 1) != 0);
            EXPECT_EQ(lanes_of(lanes)[k], (lanes >> k & 1) != 0 ? -1 : 0);
        }
    }
}

TEST(Lanes, OfAllLanes) {
    WideDoubles lanes{};
    double sum = 0;
    for (std::size_t i = 0; i < wide_doubles; ++i) {
        lanes[i] = i % 3 == 1 ? -static_cast<double>(i) : 10.0 * static_cast<double>(i);
        sum += lanes[i];
    }
    EXPECT_EQ(sum_of(lanes), sum);
    EXPECT_EQ(smallest_of(lanes), wide_doubles == 8 ? -7 : -1);
    EXPECT_EQ(largest_of(lanes), wide_doubles == 8 ? 60 : 30);
}

} // namespace
} // namespace framelet
