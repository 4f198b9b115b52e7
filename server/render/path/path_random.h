// Random numbers of paths: for each pixel a Sobol sequence of its own in each pair of dimensions, shuffled and
// scrambled by hashes ([Burley 2020]). In: seed, pixel, sample, dimension. Out: the same numbers each time.
#pragma once

#include "common/math.h"
#include "common/mix_bits.h"
#include "server/render/light/sphere_sampling.h"

namespace framelet {

inline std::uint32_t hashed(std::uint32_t a, std::uint32_t b) {
    return mix_bits(mix_bits(a) + b);
}

/// An Owen scrambling of the bits, those of greatest weight first ([Vegdahl 2021]).
inline std::uint32_t scrambled(std::uint32_t bits, std::uint32_t seed) {
    bits = reversed_bits(bits);
    bits ^= bits * 0x3d20adeau;
    bits += seed;
    bits *= (seed >> 16) | 1u;
    bits ^= bits * 0x05526c56u;
    bits ^= bits * 0x53a22864u;
    return reversed_bits(bits);
}

/// Two numbers in [0, 1). The first 2^k samples of a pixel are stratified in each pair of dimensions.
inline Vec2 random_pair(std::uint32_t pixel_seed, std::uint32_t sample, std::uint32_t pair) {
    std::uint32_t const seed = hashed(pixel_seed, pair);
    std::uint32_t index = scrambled(sample, hashed(seed, 1)); // a shuffle: blocks of 2^k stay together
    std::uint32_t const first = reversed_bits(index);
    std::uint32_t second = 0;
    for (std::uint32_t column = 1u << 31; index != 0; index >>= 1, column ^= column >> 1) {
        second ^= (index & 1) != 0 ? column : 0;
    }
    return {unit_fraction(scrambled(first, hashed(seed, 2))), unit_fraction(scrambled(second, hashed(seed, 3)))};
}

} // namespace framelet
