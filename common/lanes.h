// Eight numbers that are worked on at a time: the compiler's vectors, whatever the processor has.
#pragma once

#include <cstdint>

#ifdef __AVX2__
#include <immintrin.h>
#endif

namespace framelet {

inline constexpr int lane_count = 8;

using FloatLanes = float __attribute__((vector_size(4 * lane_count)));
/// Comparisons of lanes yield these: 0 or -1.
using IntLanes = std::int32_t __attribute__((vector_size(4 * lane_count)));

/// 0, 1, ... 7.
inline constexpr FloatLanes lane_numbers{0, 1, 2, 3, 4, 5, 6, 7};

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

} // namespace framelet
