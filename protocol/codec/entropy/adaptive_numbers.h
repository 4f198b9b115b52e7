// Codes whole numbers as decisions of a range coder, small ones for little. In: numbers. Out: decisions, and back: each
// function gives the number that was coded, and a reader does not look at the one that it is given.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "common/error.h"
#include "protocol/codec/entropy/range_coder.h"

namespace framelet {

/// Model of a number below 2^bits: its highest bit first, each bit in the context of those before it.
template <int bits>
struct AdaptiveTree {
    std::array<AdaptiveBit, std::size_t{1} << bits> nodes;

    template <class Coder>
    unsigned code(Coder& coder, unsigned number) {
        unsigned node = 1;
        for (int i = bits - 1; i >= 0; --i) {
            node = node << 1 | (coder.bit(nodes[node], (number >> i & 1) != 0) ? 1u : 0u);
        }
        return node - (1u << bits);
    }
};

/// Model of a number from 0 on: so many yeses up to `unary`, then how many bits the rest has, and these (Exp-Golomb).
template <int unary>
struct AdaptiveSize {
    static constexpr int most_bits = 17;
    std::array<AdaptiveBit, unary> steps;
    std::array<AdaptiveBit, most_bits> lengths, highest;

    /// Codes `number`, which is at most `unary` + 2^16. ProtocolError where the length that is read is 17 bits or more.
    template <class Coder>
    std::uint32_t code(Coder& coder, std::uint32_t number) {
        for (std::uint32_t i = 0; i < unary; ++i) {
            if (!coder.bit(steps[i], number > i)) {
                return i;
            }
        }
        std::uint32_t const rest = Coder::reads ? 0 : number - unary + 1;
        int const wanted = static_cast<int>(std::bit_width(rest)) - 1;
        int length = 0;
        while (coder.bit(lengths[static_cast<std::size_t>(length)], wanted > length)) {
            if (++length == most_bits) {
                throw ProtocolError("a batch has a number that is too large");
            }
        }
        std::uint32_t value = 1;
        for (int i = length - 1; i >= 0; --i) {
            bool const bit = (rest >> i & 1) != 0;
            bool const is_highest = i == length - 1;
            value =
                value << 1 |
                ((is_highest ? coder.bit(highest[static_cast<std::size_t>(length)], bit) : coder.even_bit(bit)) ? 1u
                                                                                                                : 0u);
        }
        return value - 1 + unary;
    }
};

/// Model of a signed number whose sign is as likely as not.
template <int unary>
struct AdaptiveNumber {
    AdaptiveSize<unary> size;

    /// Codes `number`, -2^15 .. 2^15 - 1; what is read is taken modulo 2^16.
    template <class Coder>
    std::int16_t code(Coder& coder, std::int16_t number) {
        std::uint32_t const magnitude =
            size.code(coder, static_cast<std::uint32_t>(number < 0 ? -std::int32_t{number} : std::int32_t{number}));
        bool const is_negative = magnitude != 0 && coder.even_bit(number < 0);
        auto const value = static_cast<std::int32_t>(magnitude);
        return static_cast<std::int16_t>(is_negative ? -value : value);
    }
};

} // namespace framelet
