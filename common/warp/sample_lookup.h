// Looks up the four samples around each of several pixels: from registers where they lie near each other, else
// gathered. In: a patch's grid, the indices of the upper left samples in it. Out: samples.
#pragma once

#include <algorithm>
#include <cstdint>

#include "common/simd/lanes.h"
#include "common/warp/warp_patch.h"

namespace framelet {

struct SamplesAround {
    WideInts above_left, above_right, below_left, below_right;
};

#ifdef __AVX512F__

// Masks of all lanes: GCC 12 warns of what the functions without a mask leave unset.
inline constexpr __mmask16 all_lanes = 0xffff;

inline WideInts gather(PackedSample const* grid, __m512i index) {
    return reinterpret_cast<WideInts>(
        _mm512_mask_i32gather_epi32(_mm512_setzero_si512(), all_lanes, index, grid, sizeof(PackedSample)));
}

/// Sixteen samples in a row for each of the two rows of pixels, from which those of each are picked.
class SampleRows {
public:
    SampleRows(PackedSample const* first, PackedSample const* second)
        : first_(_mm512_loadu_si512(first)), second_(_mm512_loadu_si512(second)) {}

    WideInts pick(__m512i index) const {
        return reinterpret_cast<WideInts>(_mm512_permutex2var_epi32(first_, index, second_));
    }

private:
    __m512i first_, second_;
};

[[gnu::always_inline]] inline SamplesAround look_up(WarpPatch const& patch, WideInts corners) {
    constexpr int register_samples = 16;
    PackedSample const* const grid = patch.grid;
    std::int32_t const n = patch.stride;
    SamplesAround out;
    std::int32_t const last = n * (patch.side - 2) + patch.side; // end of the samples that have a row below them
    auto const corner = reinterpret_cast<__m512i>(corners);
    if (last < register_samples) { // the smallest grid fits into one register
        __m512i const all = _mm512_loadu_si512(grid);
        auto const pick = [&](int offset) {
            return reinterpret_cast<WideInts>(
                _mm512_maskz_permutexvar_epi32(all_lanes, _mm512_add_epi32(corner, _mm512_set1_epi32(offset)), all));
        };
        out.above_left = pick(0);
        out.above_right = pick(1);
        out.below_left = pick(n);
        out.below_right = pick(n + 1);
        return out;
    }
    // In each row of pixels, samples are loaded from the first pixel's sample on.
    __m512i const first_ones = reinterpret_cast<__m512i>(wide_columns * wide_row);
    __m512i const base =
        _mm512_maskz_min_epi32(all_lanes, _mm512_maskz_permutexvar_epi32(all_lanes, first_ones, corner),
                               _mm512_set1_epi32(last - register_samples));
    __m512i const left = _mm512_sub_epi32(corner, base);
    if (_mm512_cmpge_epu32_mask(left, _mm512_set1_epi32(register_samples - 1)) == 0) {
        PackedSample const* const first = grid + std::min(corners[0], last - register_samples);
        PackedSample const* const second = grid + std::min(corners[wide_columns], last - register_samples);
        SampleRows const above(first, second);
        SampleRows const below(first + n, second + n);
        __m512i const left_index = _mm512_add_epi32(left, reinterpret_cast<__m512i>(register_samples * wide_row));
        __m512i const right_index = _mm512_add_epi32(left, reinterpret_cast<__m512i>(register_samples * wide_row + 1));
        out.above_left = above.pick(left_index);
        out.above_right = above.pick(right_index);
        out.below_left = below.pick(left_index);
        out.below_right = below.pick(right_index);
        return out;
    }
    out.above_left = gather(grid, corner);
    out.above_right = gather(grid + 1, corner);
    out.below_left = gather(grid + n, corner);
    out.below_right = gather(grid + n + 1, corner);
    return out;
}

#elif defined(__AVX2__)

inline __m256i load(PackedSample const* from) {
    return _mm256_loadu_si256(reinterpret_cast<__m256i const*>(from));
}

inline WideInts pick(__m256i samples, __m256i index) {
    return reinterpret_cast<WideInts>(_mm256_permutevar8x32_epi32(samples, index));
}

inline constexpr int register_samples = wide_count;

/// Sixteen samples in a row in two registers, from which any eight are picked; a gather takes several times as long.
class TwoRegisters {
public:
    explicit TwoRegisters(PackedSample const* row) : low_(load(row)), high_(load(row + register_samples)) {}

    WideInts pick(__m256i index) const {
        __m256i const low = _mm256_permutevar8x32_epi32(low_, index);
        __m256i const high = _mm256_permutevar8x32_epi32(high_, index);
        return reinterpret_cast<WideInts>(_mm256_blendv_ps(_mm256_castsi256_ps(low), _mm256_castsi256_ps(high),
                                                           _mm256_castsi256_ps(_mm256_slli_epi32(index, 28))));
    }

private:
    __m256i low_, high_;
};

/// Gathers two neighbours at each of eight indices.
inline void gather_pairs(PackedSample const* grid, __m256i index, WideInts& left, WideInts& right) {
    auto const* const pairs = reinterpret_cast<long long const*>(grid);
    __m256 const low = _mm256_castsi256_ps(_mm256_i32gather_epi64(pairs, _mm256_castsi256_si128(index), 4));
    __m256 const high = _mm256_castsi256_ps(_mm256_i32gather_epi64(pairs, _mm256_extracti128_si256(index, 1), 4));
    auto const ordered = [](__m256 mixed) {
        return reinterpret_cast<WideInts>(_mm256_permute4x64_epi64(_mm256_castps_si256(mixed), 0b11011000));
    };
    left = ordered(_mm256_shuffle_ps(low, high, 0b10001000));
    right = ordered(_mm256_shuffle_ps(low, high, 0b11011101));
}

[[gnu::always_inline]] inline SamplesAround look_up(WarpPatch const& patch, WideInts corners) {
    PackedSample const* const grid = patch.grid;
    std::int32_t const n = patch.stride;
    auto const corner = reinterpret_cast<__m256i>(corners);
    std::int32_t const first = corners[0];
    std::int32_t const last = n * (patch.side - 2) + patch.side; // end of the samples that have a row below them
    SamplesAround out;
    // One register has all left samples, another one all right ones.
    std::int32_t base = std::min(first, last - register_samples - 1);
    __m256i index = _mm256_sub_epi32(corner, _mm256_set1_epi32(base));
    if (_mm256_testz_si256(index, _mm256_set1_epi32(-register_samples)) != 0) {
        PackedSample const* const row = grid + base;
        out.above_left = pick(load(row), index);
        out.above_right = pick(load(row + 1), index);
        out.below_left = pick(load(row + n), index);
        out.below_right = pick(load(row + n + 1), index);
        return out;
    }
    base = std::max(std::min(first, last - 2 * register_samples), 0);
    // The samples of the row below must end within the grid, the smallest of which fits into two registers.
    std::int32_t const below = base + (last >= 2 * register_samples ? n : 0);
    index = _mm256_sub_epi32(corner, _mm256_set1_epi32(base));
    __m256i const next = _mm256_add_epi32(index, _mm256_set1_epi32(1));
    if (_mm256_testz_si256(_mm256_or_si256(index, next), _mm256_set1_epi32(-2 * register_samples)) != 0) {
        TwoRegisters const above_row(grid + base);
        TwoRegisters const below_row(grid + below);
        __m256i const offset = _mm256_set1_epi32(base + n - below);
        out.above_left = above_row.pick(index);
        out.above_right = above_row.pick(next);
        out.below_left = below_row.pick(_mm256_add_epi32(index, offset));
        out.below_right = below_row.pick(_mm256_add_epi32(next, offset));
        return out;
    }
    gather_pairs(grid, corner, out.above_left, out.above_right);
    gather_pairs(grid + n, corner, out.below_left, out.below_right);
    return out;
}

#else

[[gnu::always_inline]] inline SamplesAround look_up(WarpPatch const& patch, WideInts corners) {
    SamplesAround out;
    std::int32_t const n = patch.stride;
    for (int k = 0; k < wide_count; ++k) {
        PackedSample const* const corner = patch.grid + corners[k];
        out.above_left[k] = static_cast<std::int32_t>(corner[0]);
        out.above_right[k] = static_cast<std::int32_t>(corner[1]);
        out.below_left[k] = static_cast<std::int32_t>(corner[n]);
        out.below_right[k] = static_cast<std::int32_t>(corner[n + 1]);
    }
    return out;
}

#endif

} // namespace framelet
