#include "common/patch_sampling.h"

#include <algorithm>
#include <cmath>

#ifdef __AVX2__
#include <immintrin.h>
#endif

namespace framelet {

namespace {

constexpr int lanes = sampling_lanes;

template <class T>
using Lanes = Candidate::Lanes<T>;

/// Between which samples pixels fall: columns and first samples of rows, and the weights of both. Outside of the grid
/// or the box all weights across are 0.
struct Places {
    alignas(64) Lanes<std::int32_t> left, right, above, below;
    alignas(64) Lanes<float> left_weight, right_weight, above_weight, below_weight;
};

/// The four samples around each pixel.
struct Samples {
    alignas(64) Lanes<PackedSample> above_left, above_right, below_left, below_right;
};

void find_places(WarpPatch const& patch, float x, float y, float first, float last, Places& out) {
    float const u0 = patch.at[0] + y * patch.dy[0] + x * patch.dx[0];
    float const v0 = patch.at[1] + y * patch.dy[1] + x * patch.dx[1];
    float const z0 = patch.at[2] + y * patch.dy[2] + x * patch.dx[2];
    float const du = patch.dx[0], dv = patch.dx[1], dz = patch.dx[2];
    std::int32_t const n = patch.side;
    std::int32_t const end = n - 1;
    auto const outside = static_cast<float>(n);
    for (int i = 0; i < lanes; ++i) {
        auto const k = static_cast<std::size_t>(i);
        auto const step = static_cast<float>(i);
        float const inverse_z = z0 + step * dz;
        float const z = 1 / inverse_z;
        float u = (u0 + step * du) * z;
        float v = (v0 + step * dv) * z;
        bool const inside =
            (inverse_z > 0) & (step >= first) & (step < last) & (u > -1) & (u < outside) & (v > -1) & (v < outside);
        u = u > -1 ? u : -1; // not a number becomes one
        v = v > -1 ? v : -1;
        u = u < outside ? u : outside;
        v = v < outside ? v : outside;
        float const fu = std::floor(u);
        float const fv = std::floor(v);
        auto const iu = static_cast<std::int32_t>(fu);
        auto const iv = static_cast<std::int32_t>(fv);
        out.left[k] = std::min(std::max(iu, 0), end);
        out.right[k] = std::min(iu + 1, end);
        out.above[k] = std::min(std::max(iv, 0), end) * n;
        out.below[k] = std::min(iv + 1, end) * n;
        float const scale = inside ? 1.0f : 0.0f;
        out.left_weight[k] = iu >= 0 ? 1 - (u - fu) : 0.0f;
        out.right_weight[k] = iu < end ? u - fu : 0.0f;
        out.above_weight[k] = iv >= 0 ? scale - scale * (v - fv) : 0.0f;
        out.below_weight[k] = iv < end ? scale * (v - fv) : 0.0f;
    }
}

void gather(PackedSample const* grid, Places const& places, Samples& out) {
    for (std::size_t k = 0; k < lanes; ++k) {
        out.above_left[k] = grid[places.above[k] + places.left[k]];
        out.above_right[k] = grid[places.above[k] + places.right[k]];
        out.below_left[k] = grid[places.below[k] + places.left[k]];
        out.below_right[k] = grid[places.below[k] + places.right[k]];
    }
}

#ifdef __AVX2__

/// A row of up to 16 samples in two registers, from which any eight are picked; a gather takes several times as long.
class RegisterRow {
public:
    RegisterRow(PackedSample const* row, std::int32_t side)
        : low_(load(row)), high_(load(side > lanes ? row + lanes : row)) {}

    void pick(Lanes<std::int32_t> const& columns, Lanes<PackedSample>& out) const {
        __m256i const index = _mm256_load_si256(reinterpret_cast<__m256i const*>(columns.data()));
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

bool are_equal(Lanes<std::int32_t> const& values) {
    __m256i const all = _mm256_load_si256(reinterpret_cast<__m256i const*>(values.data()));
    return _mm256_movemask_epi8(_mm256_cmpeq_epi32(all, _mm256_set1_epi32(values[0]))) == -1;
}

void look_up(WarpPatch const& patch, Places const& places, Samples& out) {
    if (!are_equal(places.above) || !are_equal(places.below) || patch.side < lanes) {
        gather(patch.grid, places, out);
        return;
    }
    RegisterRow const above(patch.grid + places.above[0], patch.side);
    RegisterRow const below(patch.grid + places.below[0], patch.side);
    above.pick(places.left, out.above_left);
    above.pick(places.right, out.above_right);
    below.pick(places.left, out.below_left);
    below.pick(places.right, out.below_right);
}

#else

void look_up(WarpPatch const& patch, Places const& places, Samples& out) {
    gather(patch.grid, places, out);
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

} // namespace

void sample_patch(WarpPatch const& patch, float x, float y, float first, float last, Candidate& out) {
    Places places;
    Samples samples;
    find_places(patch, x, y, first, last, places);
    look_up(patch, places, samples);
    if (patch.is_whole) {
        interpolate<true>(patch.layer, places, samples, out);
    } else {
        interpolate<false>(patch.layer, places, samples, out);
    }
    float const w0 = patch.inverse_depth + y * patch.inverse_depth_dy + x * patch.inverse_depth_dx;
    for (int i = 0; i < lanes; ++i) {
        float const depth = w0 + static_cast<float>(i) * patch.inverse_depth_dx;
        out.inverse_depth[static_cast<std::size_t>(i)] = depth > 0 ? depth : 0.0f;
    }
}

} // namespace framelet
