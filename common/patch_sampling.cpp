#include "common/patch_sampling.h"

#include <algorithm>
#include <cmath>

#ifdef __AVX2__
#include <immintrin.h>
#endif

namespace framelet {

namespace {

constexpr int lanes = sampling_lanes;
constexpr std::size_t most_rows = std::tuple_size_v<CandidateRows>;

template <class T>
using Lanes = Candidate::Lanes<T>;

/// Between which samples pixels fall: the upper left one of four in the grid, and the weights of columns and rows.
struct Places {
    alignas(64) Lanes<std::int32_t> corner;
    alignas(64) Lanes<float> left_weight, right_weight, above_weight, below_weight;
};

/// The four samples around each pixel.
struct Samples {
    alignas(64) Lanes<PackedSample> above_left, above_right, below_left, below_right;
};

/// Beyond the outermost samples the corner is the last one that has neighbours, and tents give the weights: 0 from a
/// sample's distance on. Outside of the box and behind the camera rows have no weight.
void find_places(WarpPatch const& patch, float x, float y, Lanes<float> const& in_box, Places& out) {
    float const du = patch.dx[0], dv = patch.dx[1], dz = patch.dx[2];
    float const u0 = patch.at[0] + y * patch.dy[0] + x * du;
    float const v0 = patch.at[1] + y * patch.dy[1] + x * dv;
    float const z0 = patch.at[2] + y * patch.dy[2] + x * dz;
    auto const n = static_cast<float>(patch.side);
    float const last = n - 2;
    for (int i = 0; i < lanes; ++i) {
        auto const k = static_cast<std::size_t>(i);
        auto const step = static_cast<float>(i);
        float const inverse_z = z0 + step * dz;
        float const z = 1 / inverse_z;
        float u = (u0 + step * du) * z;
        float v = (v0 + step * dv) * z;
        u = u > -1 ? u : -1; // not a number becomes one
        v = v > -1 ? v : -1;
        u = u < n ? u : n;
        v = v < n ? v : n;
        float const column = std::min(std::max(std::floor(u), 0.0f), last);
        float const row = std::min(std::max(std::floor(v), 0.0f), last);
        float const scale = inverse_z > 0 ? in_box[k] : 0.0f;
        out.corner[k] = static_cast<std::int32_t>(row * n + column);
        out.left_weight[k] = std::max(1 - std::abs(u - column), 0.0f);
        out.right_weight[k] = std::max(1 - std::abs(u - column - 1), 0.0f);
        out.above_weight[k] = scale * std::max(1 - std::abs(v - row), 0.0f);
        out.below_weight[k] = scale * std::max(1 - std::abs(v - row - 1), 0.0f);
    }
}

#ifdef __AVX2__

/// Sixteen samples in a row in two registers, from which any eight are picked; a gather takes several times as long.
class RegisterRow {
public:
    explicit RegisterRow(PackedSample const* row) : low_(load(row)), high_(load(row + lanes)) {}

    void pick(__m256i index, Lanes<PackedSample>& out) const {
        __m256i const low = _mm256_permutevar8x32_epi32(low_, index);
        __m256i const high = _mm256_permutevar8x32_epi32(high_, index);
        __m256 const picked = _mm256_blendv_ps(_mm256_castsi256_ps(low), _mm256_castsi256_ps(high),
                                               _mm256_castsi256_ps(_mm256_slli_epi32(index, 28)));
        _mm256_store_si256(reinterpret_cast<__m256i*>(out.data()), _mm256_castps_si256(picked));
    }

private:
    static __m256i load(PackedSample const* from) { return _mm256_loadu_si256(reinterpret_cast<__m256i const*>(from)); }

    __m256i low_, high_;
};

constexpr int register_samples = 2 * lanes;

/// Two neighbours at each of eight places.
void gather_pairs(PackedSample const* grid, __m256i index, Lanes<PackedSample>& left, Lanes<PackedSample>& right) {
    auto const* const pairs = reinterpret_cast<long long const*>(grid);
    __m256 const low = _mm256_castsi256_ps(_mm256_i32gather_epi64(pairs, _mm256_castsi256_si128(index), 4));
    __m256 const high = _mm256_castsi256_ps(_mm256_i32gather_epi64(pairs, _mm256_extracti128_si256(index, 1), 4));
    auto const store = [](__m256 mixed, Lanes<PackedSample>& out) {
        __m256i const ordered = _mm256_permute4x64_epi64(_mm256_castps_si256(mixed), 0b11011000);
        _mm256_store_si256(reinterpret_cast<__m256i*>(out.data()), ordered);
    };
    store(_mm256_shuffle_ps(low, high, 0b10001000), left);
    store(_mm256_shuffle_ps(low, high, 0b11011101), right);
}

void look_up(WarpPatch const& patch, Places const& places, Samples& out) {
    std::int32_t const n = patch.side;
    __m256i const corner = _mm256_load_si256(reinterpret_cast<__m256i const*>(places.corner.data()));
    __m256i const one = _mm256_set1_epi32(1);
    // Where the registers begin: those of the row below must end within the grid, of which the smallest fits into them.
    std::int32_t const base = std::max(std::min(places.corner[0], n * (n - 1) - register_samples), 0);
    std::int32_t const below = base + (n * n > register_samples ? n : 0);
    __m256i const index = _mm256_sub_epi32(corner, _mm256_set1_epi32(base));
    __m256i const far = _mm256_or_si256(_mm256_cmpgt_epi32(index, _mm256_set1_epi32(register_samples - 2)),
                                        _mm256_cmpgt_epi32(_mm256_setzero_si256(), index));
    if (_mm256_testz_si256(far, far) == 0) {
        gather_pairs(patch.grid, corner, out.above_left, out.above_right);
        gather_pairs(patch.grid + n, corner, out.below_left, out.below_right);
        return;
    }
    RegisterRow const above_row(patch.grid + base);
    RegisterRow const below_row(patch.grid + below);
    __m256i const below_index = _mm256_add_epi32(index, _mm256_set1_epi32(base + n - below));
    above_row.pick(index, out.above_left);
    above_row.pick(_mm256_add_epi32(index, one), out.above_right);
    below_row.pick(below_index, out.below_left);
    below_row.pick(_mm256_add_epi32(below_index, one), out.below_right);
}

#else

void look_up(WarpPatch const& patch, Places const& places, Samples& out) {
    for (std::size_t k = 0; k < lanes; ++k) {
        PackedSample const* const corner = patch.grid + places.corner[k];
        out.above_left[k] = corner[0];
        out.above_right[k] = corner[1];
        out.below_left[k] = corner[patch.side];
        out.below_right[k] = corner[patch.side + 1];
    }
}

#endif

/// `whole`: all samples of the grid lie on the layer.
template <bool whole>
void interpolate(std::uint32_t layer, Places const& places, Samples const& samples, Candidate& out) {
    for (std::size_t k = 0; k < lanes; ++k) {
        PackedSample const s00 = samples.above_left[k];
        PackedSample const s10 = samples.above_right[k];
        PackedSample const s01 = samples.below_left[k];
        PackedSample const s11 = samples.below_right[k];
        auto const weight = [layer](PackedSample sample, float product) {
            return whole || layer_of(sample) == layer ? product : 0.0f;
        };
        float const a00 = weight(s00, places.left_weight[k] * places.above_weight[k]);
        float const a10 = weight(s10, places.right_weight[k] * places.above_weight[k]);
        float const a01 = weight(s01, places.left_weight[k] * places.below_weight[k]);
        float const a11 = weight(s11, places.right_weight[k] * places.below_weight[k]);
        out.weight[k] = (a00 + a10) + (a01 + a11);
        out.red[k] = (a00 * square(red_of(s00)) + a10 * square(red_of(s10))) +
                     (a01 * square(red_of(s01)) + a11 * square(red_of(s11)));
        out.green[k] = (a00 * square(green_of(s00)) + a10 * square(green_of(s10))) +
                       (a01 * square(green_of(s01)) + a11 * square(green_of(s11)));
        out.blue[k] = (a00 * square(blue_of(s00)) + a10 * square(blue_of(s10))) +
                      (a01 * square(blue_of(s01)) + a11 * square(blue_of(s11)));
    }
}

void interpolate_depth(WarpPatch const& patch, float x, float y, Candidate& out) {
    float const step = patch.inverse_depth_dx;
    float const first = patch.inverse_depth + y * patch.inverse_depth_dy + x * step;
    for (int i = 0; i < lanes; ++i) {
        float const depth = first + static_cast<float>(i) * step;
        out.inverse_depth[static_cast<std::size_t>(i)] = depth > 0 ? depth : 0.0f;
    }
}

} // namespace

void sample_patch(WarpPatch const& patch, float x, float y, int rows, Candidate::Lanes<float> const& in_box,
                  CandidateRows& out) {
    // One step after the other for all rows: a row's steps depend on each other, the rows do not.
    std::array<Places, most_rows> places;
    std::array<Samples, most_rows> samples;
    auto const count = static_cast<std::size_t>(rows);
    for (std::size_t row = 0; row < count; ++row) {
        find_places(patch, x, y + static_cast<float>(row), in_box, places[row]);
    }
    for (std::size_t row = 0; row < count; ++row) {
        look_up(patch, places[row], samples[row]);
    }
    for (std::size_t row = 0; row < count; ++row) {
        if (patch.is_whole) {
            interpolate<true>(patch.layer, places[row], samples[row], out[row]);
        } else {
            interpolate<false>(patch.layer, places[row], samples[row], out[row]);
        }
        interpolate_depth(patch, x, y + static_cast<float>(row), out[row]);
    }
}

} // namespace framelet
