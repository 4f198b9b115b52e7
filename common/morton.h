// Morton order ([Morton 1966]): the index of (x, y) interleaves their bits, x being the low bit of each pair.
#pragma once

#include <cstdint>

namespace framelet {

/// Spreads the low 16 bits of `v` to the even bits.
constexpr std::uint32_t spread_bits(std::uint32_t v) {
    v &= 0xffffu;
    v = (v | (v << 8)) & 0x00ff00ffu;
    v = (v | (v << 4)) & 0x0f0f0f0fu;
    v = (v | (v << 2)) & 0x33333333u;
    v = (v | (v << 1)) & 0x55555555u;
    return v;
}

/// Gathers the even bits of `v` into its low 16 bits; the inverse of `spread_bits`.
constexpr std::uint32_t gather_bits(std::uint32_t v) {
    v &= 0x55555555u;
    v = (v | (v >> 1)) & 0x33333333u;
    v = (v | (v >> 2)) & 0x0f0f0f0fu;
    v = (v | (v >> 4)) & 0x00ff00ffu;
    v = (v | (v >> 8)) & 0x0000ffffu;
    return v;
}

constexpr std::uint32_t morton_index(std::uint32_t x, std::uint32_t y) {
    return spread_bits(x) | (spread_bits(y) << 1);
}
constexpr std::uint32_t morton_x(std::uint32_t index) {
    return gather_bits(index);
}
constexpr std::uint32_t morton_y(std::uint32_t index) {
    return gather_bits(index >> 1);
}

} // namespace framelet
