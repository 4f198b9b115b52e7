#include "common/patch_sampling.h"

#include <algorithm>
#include <cmath>

#ifdef __AVX2__
#include <immintrin.h>
#endif

namespace framelet {

namespace {

constexpr int lanes = sampling_lanes;

/// Weights are integers, and so are squares, which are halved: products of both and their sums have 31 bits.
constexpr float weight_unit = 32767;
constexpr std::uint32_t on_layer = 32767;
constexpr float weight_scale = 1 / (weight_unit * static_cast<float>(on_layer));
constexpr float color_scale = 2 / weight_unit;

constexpr std::uint32_t half_square(std::uint32_t byte) {
    return (byte * byte + 1) / 2;
}

/// Smallest and largest of a coordinate in the corners of an area.
struct Range {
    float least = INFINITY, most = -INFINITY;

    void include(float value) {
        least = std::min(least, value);
        most = std::max(most, value);
    }
};

} // namespace

void PatchSampler::convert_rows() {
    std::int32_t const side = patch_->side;
    for (std::int32_t v = first_row_; v <= last_row_; ++v) {
        std::int16_t* const to = &rows_[static_cast<std::size_t>(v + 1) * planes * row_stride];
        if (v < 0 || v >= side) {
            std::fill(to, to + planes * row_stride, std::int16_t{0});
        } else {
            convert_row(patch_->grid + v * side, to);
        }
    }
}

bool PatchSampler::turn_to(WarpPatch const& patch, PixelRect const& area) {
    patch_ = &patch;
    is_in_front_ = true;
    Range u, v;
    for (int corner = 0; corner < 4; ++corner) {
        auto const x = static_cast<float>((corner % 2 == 0 ? area.left : area.right - 1) - patch.box.left);
        auto const y = static_cast<float>((corner / 2 == 0 ? area.top : area.bottom - 1) - patch.box.top);
        float const inverse_z = patch.at[2] + y * patch.dy[2] + x * patch.dx[2];
        is_in_front_ = is_in_front_ && inverse_z > 0;
        u.include((patch.at[0] + y * patch.dy[0] + x * patch.dx[0]) / inverse_z);
        v.include((patch.at[1] + y * patch.dy[1] + x * patch.dx[1]) / inverse_z);
    }
    auto const side = static_cast<float>(patch.side);
    if (!is_in_front_) {
        u = v = {-1, side};
    }
    if (!(u.least < side && u.most > -1 && v.least < side && v.most > -1)) {
        return false;
    }
    first_row_ = static_cast<std::int32_t>(std::floor(std::max(v.least, -1.0f)));
    last_row_ = std::min(static_cast<std::int32_t>(std::floor(std::min(v.most, side))) + 1, patch.side);
    convert_rows();
    return true;
}

#ifdef __AVX2__

namespace {

using Floats = __m256;
using Integers = __m256i;

/// Halves of squares of the bytes at bits 0 and 16.
Integers half_squares(Integers bytes) {
    Integers const shifted = _mm256_slli_epi16(bytes, 7);
    return _mm256_mulhrs_epi16(shifted, shifted);
}

/// Eight samples of a row as two squares in each lane, and what is on the layer beside the green ones.
struct Squares {
    Integers red_blue, green_layer;

    Squares(Integers samples, Integers valid, std::uint32_t layer, bool is_whole) {
        Integers const own =
            _mm256_cmpeq_epi32(_mm256_srli_epi32(samples, 24), _mm256_set1_epi32(static_cast<int>(layer)));
        Integers const mask = is_whole ? valid : _mm256_and_si256(own, valid);
        Integers const low = _mm256_set1_epi32(0x00ff00ff);
        red_blue = _mm256_and_si256(half_squares(_mm256_and_si256(samples, low)), mask);
        Integers const green = half_squares(_mm256_and_si256(_mm256_srli_epi32(samples, 8), low));
        green_layer = _mm256_and_si256(
            _mm256_blend_epi16(green, _mm256_set1_epi32(static_cast<int>(on_layer << 16)), 0xaa), mask);
    }
};

template <bool high>
void store_plane(Integers first, Integers second, std::int16_t* to) {
    auto const half = [](Integers pairs) {
        return high ? _mm256_srli_epi32(pairs, 16) : _mm256_blend_epi16(pairs, _mm256_setzero_si256(), 0xaa);
    };
    Integers const packed = _mm256_permute4x64_epi64(_mm256_packus_epi32(half(first), half(second)), 0xd8);
    _mm256_storeu_si256(reinterpret_cast<Integers*>(to + 1), packed);
}

/// Four pairs of neighbouring values from each of two places.
Integers pick(std::int16_t const* first, std::int16_t const* second, Integers bytes) {
    auto const load = [](std::int16_t const* from) { return _mm_loadu_si128(reinterpret_cast<__m128i const*>(from)); };
    return _mm256_shuffle_epi8(_mm256_inserti128_si256(_mm256_castsi128_si256(load(first)), load(second), 1), bytes);
}

/// Four lanes of pixels need eight neighbouring values at most, beginning at `base`; else there is none.
constexpr std::int32_t most_apart = 6;

} // namespace

void PatchSampler::convert_row(PackedSample const* from, std::int16_t* to) const {
    Integers const lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    Integers const valid = _mm256_cmpgt_epi32(_mm256_set1_epi32(patch_->side), lane);
    auto const* const words = reinterpret_cast<int const*>(from);
    Squares const first(_mm256_maskload_epi32(words, valid), valid, patch_->layer, patch_->is_whole);
    Integers const rest = _mm256_cmpgt_epi32(_mm256_set1_epi32(patch_->side - lanes), lane);
    Squares const second(_mm256_maskload_epi32(words + lanes, rest), rest, patch_->layer, patch_->is_whole);
    store_plane<false>(first.red_blue, second.red_blue, to);
    store_plane<false>(first.green_layer, second.green_layer, to + row_stride);
    store_plane<true>(first.red_blue, second.red_blue, to + 2 * row_stride);
    store_plane<true>(first.green_layer, second.green_layer, to + 3 * row_stride);
}

/// False where that cannot be done: pixels lie too far apart in the patch.
bool PatchSampler::sample_together(float u0, float v0, float z0, Candidate& out) const {
    Floats const one = _mm256_set1_ps(1);
    Floats const step = _mm256_setr_ps(0, 1, 2, 3, 4, 5, 6, 7);
    auto const along = [&](float first, float each) {
        return _mm256_fmadd_ps(step, _mm256_set1_ps(each), _mm256_set1_ps(first));
    };
    auto const between = [](Floats value, std::int32_t least, std::int32_t most) { // not a number becomes `least`
        return _mm256_min_ps(_mm256_max_ps(value, _mm256_set1_ps(static_cast<float>(least))),
                             _mm256_set1_ps(static_cast<float>(most)));
    };
    Floats const z = _mm256_div_ps(one, along(z0, patch_->dx[2]));
    Floats const u = between(_mm256_mul_ps(along(u0, patch_->dx[0]), z), -1, patch_->side);
    Floats const v = between(_mm256_mul_ps(along(v0, patch_->dx[1]), z), first_row_, last_row_);
    Floats const left = _mm256_floor_ps(u);
    Floats const right_weight = _mm256_sub_ps(u, left);
    Floats const left_weight = _mm256_sub_ps(one, right_weight);

    // Along a row both coordinates only rise or only fall.
    alignas(32) std::array<std::int32_t, lanes> columns;
    Integers const column = _mm256_cvttps_epi32(left);
    _mm256_store_si256(reinterpret_cast<Integers*>(columns.data()), column);
    std::int32_t const first_base = std::min(columns[0], columns[3]);
    std::int32_t const second_base = std::min(columns[4], columns[7]);
    Integers const base = _mm256_inserti128_si256(_mm256_set1_epi32(first_base), _mm_set1_epi32(second_base), 1);
    Integers const from_base = _mm256_sub_epi32(column, base);
    if (_mm256_movemask_epi8(_mm256_cmpgt_epi32(from_base, _mm256_set1_epi32(most_apart))) != 0) {
        return false;
    }
    Integers const low_byte = _mm256_setr_epi8(0, 0, 0, 0, 4, 4, 4, 4, 8, 8, 8, 8, 12, 12, 12, 12, //
                                               0, 0, 0, 0, 4, 4, 4, 4, 8, 8, 8, 8, 12, 12, 12, 12);
    Integers const bytes =
        _mm256_add_epi8(_mm256_shuffle_epi8(_mm256_slli_epi32(from_base, 1), low_byte), _mm256_set1_epi32(0x03020100));
    auto const row_at = [](Floats value) { return static_cast<std::int32_t>(std::floor(_mm256_cvtss_f32(value))); };
    std::int32_t const v_left = row_at(v);
    std::int32_t const v_right = row_at(_mm256_permutevar8x32_ps(v, _mm256_set1_epi32(lanes - 1)));
    std::int32_t const end = std::min(std::max(v_left, v_right) + 1, last_row_);

    Integers red = _mm256_setzero_si256();
    Integers green = red, blue = red, weight = red;
    for (std::int32_t v_row = std::min(v_left, v_right); v_row <= end; ++v_row) {
        Floats const away = _mm256_sub_ps(v, _mm256_set1_ps(static_cast<float>(v_row)));
        Floats const distance = _mm256_andnot_ps(_mm256_set1_ps(-0.0f), away);
        Floats const tent = _mm256_max_ps(_mm256_setzero_ps(), _mm256_sub_ps(one, distance));
        Floats const scale = _mm256_mul_ps(tent, _mm256_set1_ps(weight_unit));
        Integers const weights =
            _mm256_or_si256(_mm256_cvtps_epi32(_mm256_mul_ps(scale, left_weight)),
                            _mm256_slli_epi32(_mm256_cvtps_epi32(_mm256_mul_ps(scale, right_weight)), 16));
        std::int16_t const* const from = row(v_row, 0) + 1;
        auto const add = [&](Integers sum, std::size_t plane) {
            std::int16_t const* const values = from + plane * row_stride;
            return _mm256_add_epi32(sum,
                                    _mm256_madd_epi16(pick(values + first_base, values + second_base, bytes), weights));
        };
        red = add(red, 0);
        green = add(green, 1);
        blue = add(blue, 2);
        weight = add(weight, 3);
    }
    auto const put = [](Integers sum, float scale, Candidate::Lanes<float>& to) {
        _mm256_store_ps(to.data(), _mm256_mul_ps(_mm256_cvtepi32_ps(sum), _mm256_set1_ps(scale)));
    };
    put(red, color_scale, out.red);
    put(green, color_scale, out.green);
    put(blue, color_scale, out.blue);
    put(weight, weight_scale, out.weight);
    return true;
}

#else

void PatchSampler::convert_row(PackedSample const* from, std::int16_t* to) const {
    std::fill(to, to + planes * row_stride, std::int16_t{0});
    for (std::int32_t i = 0; i < patch_->side; ++i) {
        PackedSample const sample = *from++;
        bool const own = patch_->is_whole || layer_of(sample) == patch_->layer;
        std::array<std::uint32_t, planes> const values{half_square(red_of(sample)), half_square(green_of(sample)),
                                                       half_square(blue_of(sample)), on_layer};
        ++to;
        for (std::size_t plane = 0; plane < planes; ++plane) {
            to[plane * row_stride] = static_cast<std::int16_t>(own ? values[plane] : 0);
        }
    }
}

bool PatchSampler::sample_together(float, float, float, Candidate&) const {
    return false;
}

#endif

void PatchSampler::sample_singly(float u0, float v0, float z0, Candidate& out) const {
    for (int i = 0; i < lanes; ++i) {
        auto const k = static_cast<std::size_t>(i);
        auto const step = static_cast<float>(i);
        float const inverse_z = z0 + step * patch_->dx[2];
        float const z = 1 / inverse_z;
        auto const between = [](float value, std::int32_t least, std::int32_t most) {
            float const above = value > static_cast<float>(least) ? value : static_cast<float>(least);
            return std::min(above, static_cast<float>(most));
        };
        float const u = between((u0 + step * patch_->dx[0]) * z, -1, patch_->side);
        float const v = between((v0 + step * patch_->dx[1]) * z, first_row_, last_row_);
        float const right_weight = u - std::floor(u);
        auto const column = static_cast<std::int32_t>(std::floor(u)) + 1;
        auto const first = static_cast<std::int32_t>(std::floor(v));
        std::array<std::int32_t, planes> sums{};
        for (std::int32_t v_row = first; v_row <= std::min(first + 1, last_row_); ++v_row) {
            float const tent = 1 - std::abs(v - static_cast<float>(v_row));
            float const scale = inverse_z > 0 ? weight_unit * tent : 0.0f;
            auto const left = static_cast<std::int32_t>(std::lrint(scale * (1 - right_weight)));
            auto const right = static_cast<std::int32_t>(std::lrint(scale * right_weight));
            for (std::size_t plane = 0; plane < planes; ++plane) {
                std::int16_t const* const pair = row(v_row, plane) + column;
                sums[plane] += left * pair[0] + right * pair[1];
            }
        }
        out.red[k] = color_scale * static_cast<float>(sums[0]);
        out.green[k] = color_scale * static_cast<float>(sums[1]);
        out.blue[k] = color_scale * static_cast<float>(sums[2]);
        out.weight[k] = weight_scale * static_cast<float>(sums[3]);
    }
}

void PatchSampler::sample(int x, int y, Candidate& out) const {
    WarpPatch const& patch = *patch_;
    auto const across = static_cast<float>(x - patch.box.left);
    auto const down = static_cast<float>(y - patch.box.top);
    auto const at = [&](std::size_t k) { return patch.at[k] + down * patch.dy[k] + across * patch.dx[k]; };
    if (!is_in_front_ || !sample_together(at(0), at(1), at(2), out)) {
        sample_singly(at(0), at(1), at(2), out);
    }
    float const w0 = patch.inverse_depth + down * patch.inverse_depth_dy + across * patch.inverse_depth_dx;
    float const dw = patch.inverse_depth_dx;
    for (int i = 0; i < lanes; ++i) {
        float const depth = w0 + static_cast<float>(i) * dw;
        out.inverse_depth[static_cast<std::size_t>(i)] = depth > 0 ? depth : 0.0f;
    }
    int const first = patch.box.left - x;
    int const last = patch.box.right - x;
    if (first > 0 || last < lanes) {
        for (int i = 0; i < lanes; ++i) {
            float& weight = out.weight[static_cast<std::size_t>(i)];
            weight = (i >= first) & (i < last) ? weight : 0.0f;
        }
    }
}

} // namespace framelet
