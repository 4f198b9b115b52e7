#include "common/patch_sampling.h"

#include <algorithm>
#include <cmath>

namespace framelet {

namespace {

/// Between which samples pixels fall: the upper left one of four in the grid, and the weights of columns and rows.
struct Places {
    IntLanes corner;
    FloatLanes left_weight, right_weight, above_weight, below_weight;
};

/// The four samples around each pixel.
struct Samples {
    IntLanes above_left, above_right, below_left, below_right;
};

/// Where a row's pixels lie in the grid: homogeneous, see `WarpPatch`.
struct Row {
    FloatLanes u, v, inverse_z;
};

/// Of pixels between samples, whose four neighbours there all are, or of any. Beyond the outermost samples the corner
/// is the last one that has neighbours, and tents give the weights: 0 from a sample's distance on. Outside of the box
/// (where `in_box` is 0) and behind the camera rows have no weight.
template <bool inside>
Places find_places(Row const& row, WarpPatch const& patch, FloatLanes in_box) {
    auto const stride = static_cast<float>(patch.stride);
    FloatLanes const zero{};
    FloatLanes const z = 1 / row.inverse_z;
    FloatLanes u = row.u * z;
    FloatLanes v = row.v * z;
    Places out;
    if constexpr (inside) {
        FloatLanes const column = __builtin_convertvector(__builtin_convertvector(u, IntLanes), FloatLanes);
        FloatLanes const line = __builtin_convertvector(__builtin_convertvector(v, IntLanes), FloatLanes);
        out.corner = __builtin_convertvector(line * stride + column, IntLanes);
        out.right_weight = u - column;
        out.left_weight = 1 - out.right_weight;
        out.below_weight = v - line;
        out.above_weight = 1 - out.below_weight;
    } else {
        FloatLanes const first = zero - 1;
        auto const n = static_cast<float>(patch.side);
        FloatLanes const end = zero + n;
        FloatLanes const last = zero + (n - 2);
        u = smaller(larger(u, first), end); // not a number becomes one
        v = smaller(larger(v, first), end);
        auto const whole = [&](FloatLanes value) {
            return __builtin_convertvector(__builtin_convertvector(smaller(larger(value, zero), last), IntLanes),
                                           FloatLanes);
        };
        FloatLanes const column = whole(u);
        FloatLanes const line = whole(v);
        out.corner = __builtin_convertvector(line * stride + column, IntLanes);
        FloatLanes const x = u - column; // from -1 to 2
        FloatLanes const y = v - line;
        FloatLanes const scale = row.inverse_z > 0 ? in_box : zero;
        out.right_weight = larger(smaller(x, 2 - x), zero);
        out.left_weight = larger(smaller(1 - x, 1 + x), zero);
        out.below_weight = scale * larger(smaller(y, 2 - y), zero);
        out.above_weight = scale * larger(smaller(1 - y, 1 + y), zero);
    }
    return out;
}

#ifdef __AVX2__

__m256i load(PackedSample const* from) {
    return _mm256_loadu_si256(reinterpret_cast<__m256i const*>(from));
}

IntLanes pick(__m256i samples, __m256i index) {
    return reinterpret_cast<IntLanes>(_mm256_permutevar8x32_epi32(samples, index));
}

constexpr int register_samples = lane_count;

/// Sixteen samples in a row in two registers, from which any eight are picked; a gather takes several times as long.
class TwoRegisters {
public:
    explicit TwoRegisters(PackedSample const* row) : low_(load(row)), high_(load(row + register_samples)) {}

    IntLanes pick(__m256i index) const {
        __m256i const low = _mm256_permutevar8x32_epi32(low_, index);
        __m256i const high = _mm256_permutevar8x32_epi32(high_, index);
        return reinterpret_cast<IntLanes>(_mm256_blendv_ps(_mm256_castsi256_ps(low), _mm256_castsi256_ps(high),
                                                           _mm256_castsi256_ps(_mm256_slli_epi32(index, 28))));
    }

private:
    __m256i low_, high_;
};

/// Two neighbours at each of eight places.
void gather_pairs(PackedSample const* grid, __m256i index, IntLanes& left, IntLanes& right) {
    auto const* const pairs = reinterpret_cast<long long const*>(grid);
    __m256 const low = _mm256_castsi256_ps(_mm256_i32gather_epi64(pairs, _mm256_castsi256_si128(index), 4));
    __m256 const high = _mm256_castsi256_ps(_mm256_i32gather_epi64(pairs, _mm256_extracti128_si256(index, 1), 4));
    auto const ordered = [](__m256 mixed) {
        return reinterpret_cast<IntLanes>(_mm256_permute4x64_epi64(_mm256_castps_si256(mixed), 0b11011000));
    };
    left = ordered(_mm256_shuffle_ps(low, high, 0b10001000));
    right = ordered(_mm256_shuffle_ps(low, high, 0b11011101));
}

[[gnu::always_inline]] inline Samples look_up(WarpPatch const& patch, IntLanes corners) {
    PackedSample const* const grid = patch.grid;
    std::int32_t const n = patch.stride;
    auto const corner = reinterpret_cast<__m256i>(corners);
    std::int32_t const first = corners[0];
    std::int32_t const last = n * (patch.side - 2) + patch.side; // where samples end of which the row below is there
    Samples out;
    // One register from which all left ones are picked, one for all right ones.
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
    // Those of the row below must end within the grid, of which the smallest fits into two registers.
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

[[gnu::always_inline]] inline Samples look_up(WarpPatch const& patch, IntLanes corners) {
    Samples out;
    std::int32_t const n = patch.stride;
    for (int k = 0; k < lane_count; ++k) {
        PackedSample const* const corner = patch.grid + corners[k];
        out.above_left[k] = static_cast<std::int32_t>(corner[0]);
        out.above_right[k] = static_cast<std::int32_t>(corner[1]);
        out.below_left[k] = static_cast<std::int32_t>(corner[n]);
        out.below_right[k] = static_cast<std::int32_t>(corner[n + 1]);
    }
    return out;
}

#endif

FloatLanes squares_of(IntLanes bytes) {
    FloatLanes const value = __builtin_convertvector(bytes & 255, FloatLanes);
    return value * value;
}

constexpr auto layer_bits = static_cast<std::int32_t>(0xff000000u);

/// `layer`: the bits of its samples.
void interpolate(std::int32_t layer, Places const& places, Samples const& samples, Candidate& out) {
    auto const weight = [layer](IntLanes sample, FloatLanes product) {
        return (sample & layer_bits) == layer ? product : FloatLanes{};
    };
    FloatLanes const a00 = weight(samples.above_left, places.left_weight * places.above_weight);
    FloatLanes const a10 = weight(samples.above_right, places.right_weight * places.above_weight);
    FloatLanes const a01 = weight(samples.below_left, places.left_weight * places.below_weight);
    FloatLanes const a11 = weight(samples.below_right, places.right_weight * places.below_weight);
    auto const sum = [&](int shift) {
        return (a00 * squares_of(samples.above_left >> shift) + a10 * squares_of(samples.above_right >> shift)) +
               (a01 * squares_of(samples.below_left >> shift) + a11 * squares_of(samples.below_right >> shift));
    };
    out.weight = (a00 + a10) + (a01 + a11);
    out.red = sum(0);
    out.green = sum(8);
    out.blue = sum(16);
}

template <bool inside>
void sample_rows(WarpPatch const& patch, float x, float y, int rows, CandidateRows& out) {
    FloatLanes const place = x + lane_numbers;
    auto const first = [&](std::size_t i) { return (patch.at[i] + y * patch.dy[i]) + place * patch.dx[i]; };
    Row row{first(0), first(1), first(2)};
    FloatLanes depth = (patch.inverse_depth + y * patch.inverse_depth_dy) + place * patch.inverse_depth_dx;
    IntLanes const is_in_box = (place >= 0) & (place < static_cast<float>(patch.box.width()));
    FloatLanes const zero{};
    FloatLanes const in_box = is_in_box ? zero + 1 : zero;
    // One step after the other for all rows: a row's steps wait for each other, the rows do not.
    std::array<Places, std::tuple_size_v<CandidateRows>> places;
    auto const count = static_cast<std::size_t>(rows);
    for (std::size_t i = 0; i < count; ++i) {
        places[i] = find_places<inside>(row, patch, in_box);
        row.u += patch.dy[0];
        row.v += patch.dy[1];
        row.inverse_z += patch.dy[2];
    }
    for (std::size_t i = 0; i < count; ++i) {
        interpolate(static_cast<std::int32_t>(patch.layer << 24), places[i], look_up(patch, places[i].corner), out[i]);
        out[i].inverse_depth = larger(depth, zero);
        depth += patch.inverse_depth_dy;
    }
}

/// All of these pixels lie in the box and between four samples.
bool is_inside(WarpPatch const& patch, float x, float y, int rows) {
    constexpr float margin = 1e-3f; // more than rounding
    if (!(x >= 0 && x + lane_count <= static_cast<float>(patch.box.width()))) {
        return false;
    }
    float const most = static_cast<float>(patch.side) - 1 - margin;
    bool inside = true;
    for (int corner = 0; corner < 4; ++corner) {
        float const cx = x + static_cast<float>(corner % 2 * (lane_count - 1));
        float const cy = y + static_cast<float>(corner / 2 * (rows - 1));
        auto const at = [&](std::size_t i) { return patch.at[i] + cx * patch.dx[i] + cy * patch.dy[i]; };
        float const z = at(2);
        float const u = at(0);
        float const v = at(1);
        inside &= (z > 0) & (u > margin * z) & (v > margin * z) & (u < most * z) & (v < most * z);
    }
    return inside;
}

} // namespace

void sample_patch(WarpPatch const& patch, float x, float y, int rows, CandidateRows& out) {
    bool const inside = is_inside(patch, x, y, rows);
    inside ? sample_rows<true>(patch, x, y, rows, out) : sample_rows<false>(patch, x, y, rows, out);
}

} // namespace framelet
