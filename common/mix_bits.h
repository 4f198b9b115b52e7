// Mixing of bits: for fingerprints of what is compared only with what the same program saw before, for places in tables
// and for numbers that look random. No protection from somebody who wants two values to be alike.
#pragma once

#include <cstdint>

namespace framelet {

/// A fingerprint of `word` after what `state` is one of; the order counts. The identity of a scene on the wire is made
/// of these values.
constexpr std::uint64_t mix_in(std::uint64_t state, std::uint64_t word) {
    state = (state ^ word) * 0x9e3779b97f4a7c15u; // odd, of the golden ratio: its bits look random
    return state ^ state >> 32;
}

/// Another number for each one (Wellons, "lowbias32", 2018): each bit depends on all of `x`.
constexpr std::uint32_t mix_bits(std::uint32_t x) {
    x = (x ^ (x >> 16)) * 0x21f0aaadu;
    x = (x ^ (x >> 15)) * 0x735a2d97u;
    return x ^ (x >> 15);
}

} // namespace framelet
