// Eight numbers that are worked on at a time: the compiler's vectors, whatever the processor has.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>

#ifdef __AVX2__
#include <immintrin.h>
#endif

#ifndef __AVX2__
// Vectors wider than the processor's own are passed within the project only, all of which is compiled alike.
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

namespace framelet {

inline constexpr int lane_count = 8;

using FloatLanes = float __attribute__((vector_size(4 * lane_count)));
/// Comparisons of lanes yield these: 0 or -1.
using IntLanes = std::int32_t __attribute__((vector_size(4 * lane_count)));

/// 0, 1, ... 7.
inline constexpr FloatLanes lane_numbers{0, 1, 2, 3, 4, 5, 6, 7};

// Wherever they lie in memory.
inline FloatLanes load_lanes(float const* from) {
    FloatLanes out;
    std::memcpy(&out, from, sizeof out);
    return out;
}
inline IntLanes load_lanes(std::int32_t const* from) {
    IntLanes out;
    std::memcpy(&out, from, sizeof out);
    return out;
}
inline void store_lanes(FloatLanes const& from, float* to) {
    std::memcpy(to, &from, sizeof from);
}
inline void store_lanes(IntLanes const& from, std::int32_t* to) {
    std::memcpy(to, &from, sizeof from);
}

/// Every other one of sixteen, from the first on and from the second on.
inline FloatLanes even_of(float const* from) {
    return __builtin_shufflevector(load_lanes(from), load_lanes(from + lane_count), 0, 2, 4, 6, 8, 10, 12, 14);
}
inline FloatLanes odd_of(float const* from) {
    return __builtin_shufflevector(load_lanes(from), load_lanes(from + lane_count), 1, 3, 5, 7, 9, 11, 13, 15);
}

#ifdef __AVX2__
// (The compiler makes two operations of a comparison with 0.)
/// `b` where one of them is not a number.
inline FloatLanes smaller(FloatLanes a, FloatLanes b) {
    return _mm256_min_ps(a, b);
}
inline FloatLanes larger(FloatLanes a, FloatLanes b) {
    return _mm256_max_ps(a, b);
}
#else
inline FloatLanes smaller(FloatLanes a, FloatLanes b) {
    return a < b ? a : b;
}
inline FloatLanes larger(FloatLanes a, FloatLanes b) {
    return a > b ? a : b;
}
#endif

inline float smaller(float a, float b) {
    return std::min(a, b);
}

} // namespace framelet
