// A set of whole numbers from 0 on, a bit each, of which as many are looked at at a time as lanes hold.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "common/simd/lanes.h"

namespace framelet {

/// A set of numbers below `count`, which is a multiple of 64.
template <std::size_t count>
class LaneBits {
public:
    static LaneBits first(std::size_t numbers) {
        LaneBits out;
        for (std::size_t i = 0; i < words; ++i) {
            std::size_t const left = numbers - std::min(numbers, 64 * i);
            out.words_[i] = left >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << left) - 1;
        }
        return out;
    }
    static LaneBits only(std::size_t number) {
        LaneBits out;
        out.words_[number / 64] = std::uint64_t{1} << number % 64;
        return out;
    }

    /// A bit for each of `wide_doubles` numbers from `number` on, which is a multiple of that.
    unsigned lanes(std::size_t number) const {
        return static_cast<unsigned>(words_[number / 64] >> number % 64) & ((1u << wide_doubles) - 1);
    }
    void add_lanes(std::size_t number, unsigned bits) { words_[number / 64] |= std::uint64_t{bits} << number % 64; }

    bool any() const {
        return std::ranges::any_of(words_, [](std::uint64_t word) { return word != 0; });
    }
    /// The least number of the set, which must not be empty.
    std::size_t lowest() const {
        std::size_t i = 0;
        while (words_[i] == 0) {
            ++i;
        }
        return 64 * i + static_cast<std::size_t>(std::countr_zero(words_[i]));
    }
    template <class Visit>
    void for_each(Visit const& visit) const {
        for (std::size_t i = 0; i < words; ++i) {
            for (std::uint64_t left = words_[i]; left != 0; left &= left - 1) {
                visit(64 * i + static_cast<std::size_t>(std::countr_zero(left)));
            }
        }
    }

    LaneBits operator|(LaneBits const& other) const {
        return combined(other, [](std::uint64_t a, std::uint64_t b) { return a | b; });
    }
    LaneBits operator&(LaneBits const& other) const {
        return combined(other, [](std::uint64_t a, std::uint64_t b) { return a & b; });
    }
    LaneBits without(LaneBits const& other) const {
        return combined(other, [](std::uint64_t a, std::uint64_t b) { return a & ~b; });
    }
    bool operator==(LaneBits const&) const = default;

private:
    static constexpr std::size_t words = count / 64;
    static_assert(words * 64 == count);

    template <class Combine>
    LaneBits combined(LaneBits const& other, Combine const& combine) const {
        LaneBits out;
        for (std::size_t i = 0; i < words; ++i) {
            out.words_[i] = combine(words_[i], other.words_[i]);
        }
        return out;
    }

    std::array<std::uint64_t, words> words_{};
};

} // namespace framelet
