#include "common/warp/patch_sampling.h"

#include <algorithm>
#include <cmath>

#include "common/warp/sample_lookup.h"

namespace framelet {

namespace {

/// The samples between which pixels fall: the index in the grid of the upper left one of four, and the weights of
/// columns and rows.
struct SamplePositions {
    WideInts corner;
    WideFloats left_weight, right_weight, above_weight, below_weight;
};

/// Homogeneous coordinates of pixels in the grid, see `WarpPatch`.
struct Homogeneous {
    WideFloats u, v, inverse_z;
};

/// Finds the positions of pixels: with `inside` pixels whose four neighbours are all in the grid, else any. Beyond the
/// outermost samples the corner is the last one that has neighbours, and tents give the weights: 0 from a sample's
/// distance on. Outside of the box (where `in_box` is 0) and behind the camera there is no weight.
template <bool inside>
SamplePositions find_positions(Homogeneous const& at, WarpPatch const& patch, WideInts in_box) {
    auto const stride = static_cast<float>(patch.stride);
    WideFloats const zero{};
    WideFloats const z = 1 / at.inverse_z;
    WideFloats const u = at.u * z;
    WideFloats const v = at.v * z;
    SamplePositions out;
    if constexpr (inside) {
        // Rounding adds up along large grids that are seen at a low angle: what is read stays within the grid.
        WideInts const first{};
        WideInts const last = first + (patch.side - 2);
        auto const whole = [&](WideFloats value) {
            WideInts const truncated = __builtin_convertvector(value, WideInts);
            WideInts const bounded = truncated < last ? truncated : last;
            return __builtin_convertvector(bounded > first ? bounded : first, WideFloats);
        };
        WideFloats const column = whole(u);
        WideFloats const line = whole(v);
        out.corner = __builtin_convertvector(line * stride + column, WideInts);
        out.right_weight = u - column;
        out.left_weight = 1 - out.right_weight;
        out.below_weight = v - line;
        out.above_weight = 1 - out.below_weight;
    } else {
        WideFloats const last = zero + static_cast<float>(patch.side - 2);
        auto const whole = [&](WideFloats value) { // not a number becomes one
            return __builtin_convertvector(__builtin_convertvector(smaller(larger(value, zero), last), WideInts),
                                           WideFloats);
        };
        WideFloats const column = whole(u);
        WideFloats const line = whole(v);
        out.corner = __builtin_convertvector(line * stride + column, WideInts);
        WideFloats const x = u - column;
        WideFloats const y = v - line;
        WideInts const shows = (at.inverse_z > 0) & in_box;
        out.right_weight = larger(smaller(x, 2 - x), zero);
        out.left_weight = larger(smaller(1 - x, 1 + x), zero);
        out.below_weight = shows ? larger(smaller(y, 2 - y), zero) : zero;
        out.above_weight = shows ? larger(smaller(1 - y, 1 + y), zero) : zero;
    }
    return out;
}

WideFloats squares_of(WideInts bytes) {
    WideFloats const value = __builtin_convertvector(bytes & 255, WideFloats);
    return value * value;
}

constexpr auto layer_bits = static_cast<std::int32_t>(0xff000000u);

/// -1 for samples whose layer is in the set, else 0.
WideInts contains(LayerSet const& set, WideInts samples) {
    WideInts const layers = samples >> 24 & 255;
    WideInts const bits = pick_of_eight(set.data(), layers >> 5) >> (layers & 31);
    return (bits & 1) != 0;
}

/// Sums up the four samples around each pixel that lie on the layer. `layer`: its number, where samples have it.
void interpolate(std::int32_t layer, WarpPatch const& patch, SamplePositions const& positions,
                 SamplesAround const& samples, Candidate& out) {
    auto const weight = [layer](WideInts sample, WideFloats product) {
        return (sample & layer_bits) == layer ? product : WideFloats{};
    };
    WideFloats const a00 = weight(samples.above_left, positions.left_weight * positions.above_weight);
    WideFloats const a10 = weight(samples.above_right, positions.right_weight * positions.above_weight);
    WideFloats const a01 = weight(samples.below_left, positions.left_weight * positions.below_weight);
    WideFloats const a11 = weight(samples.below_right, positions.right_weight * positions.below_weight);
    auto const sum = [&](int shift) {
        return (a00 * squares_of(samples.above_left >> shift) + a10 * squares_of(samples.above_right >> shift)) +
               (a01 * squares_of(samples.below_left >> shift) + a11 * squares_of(samples.below_right >> shift));
    };
    out.weight = (a00 + a10) + (a01 + a11);
    out.red = sum(0);
    out.green = sum(8);
    out.blue = sum(16);
    WideInts const right = positions.right_weight >= 0.5f;
    WideInts const below = positions.below_weight >= 0.5f;
    WideInts const in_cell = (right | (positions.left_weight >= 0.5f)) & (below | (positions.above_weight >= 0.5f));
    WideInts const nearest =
        below ? (right ? samples.below_right : samples.below_left) : (right ? samples.above_right : samples.above_left);
    out.is_firm = in_cell & ((nearest & layer_bits) == layer);
    if (patch.has_ends) {
        out.ends = in_cell & contains(patch.ends_before, nearest);
    }
}

template <bool inside>
void sample_column(WarpPatch const& patch, float x, float y, int count, CandidateColumn& out) {
    WideFloats const column = x + __builtin_convertvector(wide_column, WideFloats);
    WideFloats const row = y + __builtin_convertvector(wide_row, WideFloats);
    // Each row by itself: sums from row to row round otherwise where a register has more rows.
    auto const row_of = [&](std::size_t i) { return row + static_cast<float>(i * std::size_t{wide_rows}); };
    auto const at = [&](std::size_t i, WideFloats of_row) {
        return (patch.at[i] + of_row * patch.dy[i]) + column * patch.dx[i];
    };
    WideFloats const zero{};
    WideInts const in_box = (column >= 0) & (column < static_cast<float>(patch.box.width()));
    // Each step is done for all rows before the next one: the steps of one row wait for each other.
    std::array<SamplePositions, std::tuple_size_v<CandidateColumn>> positions;
    auto const last = static_cast<std::size_t>(count);
    for (std::size_t i = 0; i < last; ++i) {
        WideFloats const at_row = row_of(i);
        positions[i] = find_positions<inside>({at(0, at_row), at(1, at_row), at(2, at_row)}, patch, in_box);
    }
    if constexpr (!inside && wide_rows > 1) { // rows may be above the box or below it
        auto const leave_out = [&](SamplePositions& some, WideInts flags) {
            some.above_weight = flags ? some.above_weight : zero;
            some.below_weight = flags ? some.below_weight : zero;
        };
        leave_out(positions[0], row >= 0);
        leave_out(positions[last - 1], row < static_cast<float>(patch.box.height() - (count - 1) * wide_rows));
    }
    for (std::size_t i = 0; i < last; ++i) {
        interpolate(static_cast<std::int32_t>(patch.layer << 24), patch, positions[i],
                    look_up(patch, positions[i].corner), out[i]);
        out[i].inverse_depth =
            larger((patch.inverse_depth + row_of(i) * patch.inverse_depth_dy) + column * patch.inverse_depth_dx, zero);
    }
}

/// True when all of these pixels lie in the box and between four samples.
bool is_inside(WarpPatch const& patch, float x, float y, int rows) {
    constexpr float margin = 1e-3f; // more than rounding
    if (!(x >= 0 && x + wide_columns <= static_cast<float>(patch.box.width()) && y >= 0 &&
          y + static_cast<float>(rows) <= static_cast<float>(patch.box.height()))) {
        return false;
    }
    // Positions in the grid of the four outermost pixels.
    using Four = float __attribute__((vector_size(16)));
    auto const right = static_cast<float>(wide_columns - 1);
    auto const below = static_cast<float>(rows - 1);
    Four const cx{x, x + right, x, x + right};
    Four const cy{y, y, y + below, y + below};
    auto const at = [&](std::size_t i) { return patch.at[i] + cx * patch.dx[i] + cy * patch.dy[i]; };
    Four const z = at(2);
    Four const u = at(0);
    Four const v = at(1);
    float const most = static_cast<float>(patch.side) - 1 - margin;
    auto const is = (z > 0) & (u > margin * z) & (v > margin * z) & (u < most * z) & (v < most * z);
    return (is[0] & is[1] & is[2] & is[3]) != 0;
}

} // namespace

bool may_show(WarpPatch const& patch, float x, float y, int count) {
    constexpr float reach = 1 + 1e-2f; // of a sample, and more than rounding
    auto const right = static_cast<float>(wide_columns - 1);
    auto const below = static_cast<float>(count * wide_rows - 1);
    float low_u = INFINITY, low_v = INFINITY, high_u = -INFINITY, high_v = -INFINITY;
    for (float const cx : {x, x + right}) {
        for (float const cy : {y, y + below}) {
            auto const at = [&](std::size_t i) { return patch.at[i] + cx * patch.dx[i] + cy * patch.dy[i]; };
            float const z = at(2);
            if (!(z > 0)) {
                return true; // what lies between the corners in the grid is not what lies between them here
            }
            low_u = std::min(low_u, at(0) / z);
            high_u = std::max(high_u, at(0) / z);
            low_v = std::min(low_v, at(1) / z);
            high_v = std::max(high_v, at(1) / z);
        }
    }
    auto const last = static_cast<float>(patch.side - 1);
    if (!(high_u > -reach && high_v > -reach && low_u < last + reach && low_v < last + reach)) {
        return false;
    }
    float const cells = 8 / static_cast<float>(patch.side); // for each sample
    auto const cell = [&](float sample) {
        return static_cast<int>(std::clamp((std::clamp(sample, 0.0f, last) + 0.5f) * cells, 0.0f, 7.0f));
    };
    int const columns = cell(high_u + reach) - cell(low_u - reach) + 1;
    std::uint64_t const line = ((std::uint64_t{1} << columns) - 1) << cell(low_u - reach);
    for (int row = cell(low_v - reach); row <= cell(high_v + reach); ++row) {
        if ((patch.occupied >> 8 * row & line) != 0) {
            return true;
        }
    }
    return false;
}

void sample_patch(WarpPatch const& patch, float x, float y, int count, CandidateColumn& out) {
    bool const inside = is_inside(patch, x, y, count * wide_rows);
    inside ? sample_column<true>(patch, x, y, count, out) : sample_column<false>(patch, x, y, count, out);
}

} // namespace framelet
