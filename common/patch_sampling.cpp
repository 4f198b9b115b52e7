#include "common/patch_sampling.h"

#include <algorithm>
#include <cmath>

#include "common/sample_lookup.h"

namespace framelet {

namespace {

/// Between which samples pixels fall: the upper left one of four in the grid, and the weights of columns and rows.
struct Places {
    WideInts corner;
    WideFloats left_weight, right_weight, above_weight, below_weight;
};

/// Where a row's pixels lie in the grid: homogeneous, see `WarpPatch`.
struct Row {
    WideFloats u, v, inverse_z;
};

/// Of pixels between samples, whose four neighbours there all are, or of any. Beyond the outermost samples the corner
/// is the last one that has neighbours, and tents give the weights: 0 from a sample's distance on. Outside of the box
/// (where `in_box` is 0) and behind the camera rows have no weight.
template <bool inside>
Places find_places(Row const& row, WarpPatch const& patch, WideFloats in_box) {
    auto const stride = static_cast<float>(patch.stride);
    WideFloats const zero{};
    WideFloats const z = 1 / row.inverse_z;
    WideFloats u = row.u * z;
    WideFloats v = row.v * z;
    Places out;
    if constexpr (inside) {
        // Rounding adds up along large grids that are seen at a low angle: what is read stays within the grid.
        WideInts const last = WideInts{} + (patch.side - 2);
        auto const whole = [&](WideFloats value) {
            WideInts const truncated = __builtin_convertvector(value, WideInts);
            return __builtin_convertvector(truncated < last ? truncated : last, WideFloats);
        };
        WideFloats const column = whole(u);
        WideFloats const line = whole(v);
        out.corner = __builtin_convertvector(line * stride + column, WideInts);
        out.right_weight = u - column;
        out.left_weight = 1 - out.right_weight;
        out.below_weight = v - line;
        out.above_weight = 1 - out.below_weight;
    } else {
        WideFloats const first = zero - 1;
        auto const n = static_cast<float>(patch.side);
        WideFloats const end = zero + n;
        WideFloats const last = zero + (n - 2);
        u = smaller(larger(u, first), end); // not a number becomes one
        v = smaller(larger(v, first), end);
        auto const whole = [&](WideFloats value) {
            return __builtin_convertvector(__builtin_convertvector(smaller(larger(value, zero), last), WideInts),
                                           WideFloats);
        };
        WideFloats const column = whole(u);
        WideFloats const line = whole(v);
        out.corner = __builtin_convertvector(line * stride + column, WideInts);
        WideFloats const x = u - column; // from -1 to 2
        WideFloats const y = v - line;
        WideFloats const scale = row.inverse_z > 0 ? in_box : zero;
        out.right_weight = larger(smaller(x, 2 - x), zero);
        out.left_weight = larger(smaller(1 - x, 1 + x), zero);
        out.below_weight = scale * larger(smaller(y, 2 - y), zero);
        out.above_weight = scale * larger(smaller(1 - y, 1 + y), zero);
    }
    return out;
}

WideFloats squares_of(WideInts bytes) {
    WideFloats const value = __builtin_convertvector(bytes & 255, WideFloats);
    return value * value;
}

constexpr auto layer_bits = static_cast<std::int32_t>(0xff000000u);

/// `layer`: the bits of its samples.
void interpolate(std::int32_t layer, Places const& places, SamplesAround const& samples, Candidate& out) {
    auto const weight = [layer](WideInts sample, WideFloats product) {
        return (sample & layer_bits) == layer ? product : WideFloats{};
    };
    WideFloats const a00 = weight(samples.above_left, places.left_weight * places.above_weight);
    WideFloats const a10 = weight(samples.above_right, places.right_weight * places.above_weight);
    WideFloats const a01 = weight(samples.below_left, places.left_weight * places.below_weight);
    WideFloats const a11 = weight(samples.below_right, places.right_weight * places.below_weight);
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
    WideFloats const place = x + __builtin_convertvector(wide_numbers, WideFloats);
    auto const first = [&](std::size_t i) { return (patch.at[i] + y * patch.dy[i]) + place * patch.dx[i]; };
    Row row{first(0), first(1), first(2)};
    WideFloats depth = (patch.inverse_depth + y * patch.inverse_depth_dy) + place * patch.inverse_depth_dx;
    WideInts const is_in_box = (place >= 0) & (place < static_cast<float>(patch.box.width()));
    WideFloats const zero{};
    WideFloats const in_box = is_in_box ? zero + 1 : zero;
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
    if (!(x >= 0 && x + sampling_lanes <= static_cast<float>(patch.box.width()))) {
        return false;
    }
    float const most = static_cast<float>(patch.side) - 1 - margin;
    bool inside = true;
    for (int corner = 0; corner < 4; ++corner) {
        float const cx = x + static_cast<float>(corner % 2 * (sampling_lanes - 1));
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
