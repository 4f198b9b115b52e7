// Four, eight or sixteen numbers that are worked on at a time: the compiler's vectors, whatever the processor has.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>

#ifdef __AVX2__
#include <immintrin.h>
#else
// Vectors wider than the processor's own are passed within the project only, all of which is compiled alike.
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

namespace framelet {

inline constexpr int lane_count = 8;

using FloatLanes = float __attribute__((vector_size(4 * lane_count)));
/// Comparisons of lanes yield these: 0 or -1.
using IntLanes = std::int32_t __attribute__((vector_size(4 * lane_count)));

/// Half as many lanes.
using HalfFloats = float __attribute__((vector_size(2 * lane_count)));

/// Lanes of 32 bits in the processor's widest registers: 8, or 16 with AVX-512.
#ifdef __AVX512F__
inline constexpr int wide_count = 16;
#else
inline constexpr int wide_count = lane_count;
#endif
using WideFloats = float __attribute__((vector_size(4 * wide_count)));
using WideInts = std::int32_t __attribute__((vector_size(4 * wide_count)));
using WideWords = std::uint32_t __attribute__((vector_size(4 * wide_count)));
using FourDoubles = double __attribute__((vector_size(32)));
/// Doubles in a vector of the same width.
inline constexpr int wide_doubles = wide_count / 2;
using WideDoubles = double __attribute__((vector_size(8 * wide_doubles)));

/// Wide lanes stand for eight pixels of a row and, where there are more lanes, of the rows below it: content with edges
/// takes fewer of such groups than of longer rows.
inline constexpr int wide_columns = lane_count;
inline constexpr int wide_rows = wide_count / lane_count;

/// Column and row of each lane in such a group of pixels.
#ifdef __AVX512F__
inline constexpr WideInts wide_column{0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7};
inline constexpr WideInts wide_row{0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1};
#else
inline constexpr WideInts wide_column{0, 1, 2, 3, 4, 5, 6, 7};
inline constexpr WideInts wide_row{};
#endif

// Lanes may lie anywhere in memory, aligned or not.
template <class Lanes = FloatLanes>
Lanes load_lanes(void const* from) {
    Lanes out;
    std::memcpy(&out, from, sizeof out);
    return out;
}
template <class Lanes>
void store_lanes(Lanes const& from, void* to) {
    std::memcpy(to, &from, sizeof from);
}

/// Every other lane of two registers, from the first on (`even_of`) and from the second on (`odd_of`).
inline FloatLanes even_of(FloatLanes a, FloatLanes b) {
    return __builtin_shufflevector(a, b, 0, 2, 4, 6, 8, 10, 12, 14);
}
inline FloatLanes odd_of(FloatLanes a, FloatLanes b) {
    return __builtin_shufflevector(a, b, 1, 3, 5, 7, 9, 11, 13, 15);
}
inline HalfFloats even_of(HalfFloats a, HalfFloats b) {
    return __builtin_shufflevector(a, b, 0, 2, 4, 6);
}
inline HalfFloats odd_of(HalfFloats a, HalfFloats b) {
    return __builtin_shufflevector(a, b, 1, 3, 5, 7);
}

#ifdef __AVX2__
// (Intrinsics: the compiler makes two operations of a comparison with 0.)
/// The smaller and the larger one in each lane; `b` where one of them is not a number.
inline FloatLanes smaller(FloatLanes a, FloatLanes b) {
    return _mm256_min_ps(a, b);
}
inline FloatLanes larger(FloatLanes a, FloatLanes b) {
    return _mm256_max_ps(a, b);
}
#ifdef __AVX512F__
// (With a mask of all lanes: GCC 12 warns of what the plain intrinsics leave unset.)
inline WideFloats smaller(WideFloats a, WideFloats b) {
    return _mm512_maskz_min_ps(0xffff, a, b);
}
inline WideFloats larger(WideFloats a, WideFloats b) {
    return _mm512_maskz_max_ps(0xffff, a, b);
}
#endif
#else
inline FloatLanes smaller(FloatLanes a, FloatLanes b) {
    return a < b ? a : b;
}
inline FloatLanes larger(FloatLanes a, FloatLanes b) {
    return a > b ? a : b;
}
#endif

/// The square root, rounded as IEEE 754 has it: estimates differ from processor to processor. No value may be less than
/// 0.
#ifdef __AVX512F__
inline WideFloats root(WideFloats value) {
    return _mm512_maskz_sqrt_ps(0xffff, value);
}
#elif defined(__AVX2__)
inline WideFloats root(WideFloats value) {
    return _mm256_sqrt_ps(value);
}
#else
inline WideFloats root(WideFloats value) {
    for (int i = 0; i < wide_count; ++i) {
        value[i] = std::sqrt(value[i]);
    }
    return value;
}
#endif

/// Picks for each lane one of eight words by the lane's index, 0 to 7.
inline WideInts pick_of_eight(std::uint32_t const* eight, WideInts index) {
#if defined(__AVX512F__)
    __m512i const all = _mm512_castsi256_si512(_mm256_loadu_si256(reinterpret_cast<__m256i const*>(eight)));
    return reinterpret_cast<WideInts>(_mm512_maskz_permutexvar_epi32(0xffff, reinterpret_cast<__m512i>(index), all));
#elif defined(__AVX2__)
    __m256i const all = _mm256_loadu_si256(reinterpret_cast<__m256i const*>(eight));
    return reinterpret_cast<WideInts>(_mm256_permutevar8x32_epi32(all, reinterpret_cast<__m256i>(index)));
#else
    WideInts out;
    for (int i = 0; i < wide_count; ++i) {
        out[i] = static_cast<std::int32_t>(eight[index[i]]);
    }
    return out;
#endif
}

/// True when a bit is set in any lane.
inline bool any_lane(WideInts flags) {
#ifdef __AVX512F__
    auto const all = reinterpret_cast<__m512i>(flags);
    return _mm512_test_epi32_mask(all, all) != 0;
#elif defined(__AVX2__)
    auto const all = reinterpret_cast<__m256i>(flags);
    return _mm256_testz_si256(all, all) == 0;
#else
    std::int32_t bits = 0;
    for (int i = 0; i < wide_count; ++i) {
        bits |= flags[i];
    }
    return bits != 0;
#endif
}

inline HalfFloats smaller(HalfFloats a, HalfFloats b) {
    return a < b ? a : b;
}
inline float smaller(float a, float b) {
    return std::min(a, b);
}

using FourLongs = std::int64_t __attribute__((vector_size(32)));

/// A bit for each lane of a comparison.
inline unsigned bits_of(FourLongs flags) {
#ifdef __AVX2__
    return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(flags)));
#else
    unsigned out = 0;
    for (unsigned i = 0; i < 4; ++i) {
        out |= (flags[i] != 0 ? 1u : 0u) << i;
    }
    return out;
#endif
}
#ifdef __AVX512F__
inline unsigned bits_of(std::int64_t __attribute__((vector_size(64))) flags) {
    return _mm512_test_epi64_mask(reinterpret_cast<__m512i>(flags), reinterpret_cast<__m512i>(flags));
}
#endif

/// A double, or lanes of doubles.
template <class Numbers>
concept OfDoubles = sizeof(Numbers) % sizeof(double) == 0 && !std::is_integral_v<Numbers>;

/// Comparisons of doubles yield these: 0 or -1.
using WideLongs = std::int64_t __attribute__((vector_size(8 * wide_doubles)));

/// Lanes that are -1 where their bit is set, else 0.
inline WideLongs lanes_of(unsigned bits) {
#ifdef __AVX512F__
    constexpr WideLongs bit{1, 2, 4, 8, 16, 32, 64, 128};
#else
    constexpr WideLongs bit{1, 2, 4, 8};
#endif
    return (bit & bits) != 0;
}

// The smaller and the larger one; `b` where one of them is not a number.
template <OfDoubles Doubles>
Doubles smaller(Doubles a, Doubles b) {
    return a < b ? a : b;
}
template <OfDoubles Doubles>
Doubles larger(Doubles a, Doubles b) {
    return a > b ? a : b;
}
template <OfDoubles Doubles>
Doubles absolute(Doubles value) {
    return value < 0 ? -value : value;
}

/// All lanes `combine`d pairwise into one number.
template <class Combine>
double of_all(WideDoubles lanes, Combine const& combine) {
#ifdef __AVX512F__
    FourDoubles const four =
        combine(__builtin_shufflevector(lanes, lanes, 0, 1, 2, 3), __builtin_shufflevector(lanes, lanes, 4, 5, 6, 7));
#else
    FourDoubles const four = lanes;
#endif
    using Two = double __attribute__((vector_size(16)));
    Two const two = combine(__builtin_shufflevector(four, four, 0, 1), __builtin_shufflevector(four, four, 2, 3));
    return combine(two[0], two[1]);
}
inline double sum_of(WideDoubles lanes) {
    return of_all(lanes, [](auto a, auto b) { return a + b; });
}
inline double smallest_of(WideDoubles lanes) {
    return of_all(lanes, [](auto a, auto b) { return smaller(a, b); });
}
inline double largest_of(WideDoubles lanes) {
    return of_all(lanes, [](auto a, auto b) { return larger(a, b); });
}

} // namespace framelet
