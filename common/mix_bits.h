// Mixing of bits, for fingerprints that are compared only with what the same program saw before, for positions in
// tables and for numbers that look random. It does not protect from somebody who wants two values to be alike.
#pragma once

#include <cstdint>

namespace framelet {

/// The fingerprint of a sequence that ends with `word`, where `state` is the fingerprint of what comes before it; the
/// order counts. The identity of a scene on the wire is made of these values.
constexpr std::uint64_t mix_in(std::uint64_t state, std::uint64_t word) {
    state = (state ^ word) * 0x9e3779b97f4a7c15u; // odd, of the golden ratio: its bits look random
    return state ^ state >> 32;
}

/// Maps each number to another one, no two to the same ([Wellons 2018], lowbias32): each bit of it depends on all of
/// `x`.
constexpr std::uint32_t mix_bits(std::uint32_t x) {
    x = (x ^ (x >> 16)) * 0x21f0aaadu;
    x = (x ^ (x >> 15)) * 0x735a2d97u;
    return x ^ (x >> 15);
}

} // namespace framelet
