#include "common/warp/warp_block.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <bitset>
#include <cmath>
#include <span>

#include "common/warp/patch_sampling.h"

namespace framelet {

namespace {

constexpr int side = WarpedBlock::side;
constexpr std::size_t pixels = WarpedBlock::pixels;

/// Weight from which on an outlier's tent is firm: within half its spacing.
constexpr float firm_tent = 0.25f;
/// Weight up to which a candidate covers nothing.
constexpr float faint = 1e-3f;
/// Inverse depths that differ by this share belong to one surface.
constexpr float same_surface = 0.01f;

/// The surface in front at each pixel so far. The left half of the block comes first, so that what is worked on
/// together lies together.
struct Layers {
    alignas(64) std::array<float, pixels> red, green, blue, weight, inverse_depth;
    alignas(64) std::array<std::int32_t, pixels> group, is_firm;
    /// Inverse depth of a surface that is known not to go as far as here; less than 0: there is none.
    alignas(64) std::array<float, pixels> ended;
    bool has_shadows = false; ///< some group drifts
};

/// Index of a pixel in `Layers`.
constexpr std::size_t index_of(int x, int y) {
    return static_cast<std::size_t>(x / wide_columns * (wide_columns * side) + y * wide_columns + x % wide_columns);
}

/// True for pixels that show a shadow clearly before this depth of a group that is none: it lies on no surface there,
/// and hides nothing.
WideInts shows_loose_shadow(WideFloats depth, WideFloats limit, std::int32_t group, std::size_t first,
                            Layers const& layers) {
    if (!layers.has_shadows || is_drifting(group)) {
        return WideInts{};
    }
    WideInts const groups = load_lanes<WideInts>(&layers.group[first]);
    return (groups >= 0) & ((groups & drifting_bit) != 0) &
           (load_lanes<WideFloats>(&layers.inverse_depth[first]) - depth > limit);
}

/// True for pixels where nothing of a group can show at such inverse depths: they are covered firmly, by what is near
/// enough, and by nothing that it would add up with.
WideInts is_hidden(WideFloats depth, float tolerance, std::int32_t group, std::size_t first, Layers const& layers) {
    constexpr float rounding = 1e-5f; // largest difference of sums along a column from those of `sample_patch`
    WideFloats const hiding = (1 + rounding - same_surface) * depth - tolerance;
    return load_lanes<WideInts>(&layers.is_firm[first]) &
           (load_lanes<WideFloats>(&layers.inverse_depth[first]) >= hiding) &
           (load_lanes<WideInts>(&layers.group[first]) != group) &
           ~shows_loose_shadow(depth, tolerance + same_surface * depth, group, first, layers);
}

/// Lets candidates compete with what pixels have; true when one of them shows. Firm wins over not firm. Of two alike
/// the clearly nearer one wins, else the one that was there, which is the better one. Those of one group on one surface
/// add up. Where better samples show that a surface has ended, others of it are not firm: else it would be as wide as
/// all together say, and one that is wrong would suffice.
bool merge(Candidate const& candidate, std::int32_t group, float tolerance, std::size_t first, bool has_ends,
           Layers& layers) {
    WideFloats const there = load_lanes<WideFloats>(&layers.inverse_depth[first]);
    WideFloats const weight = load_lanes<WideFloats>(&layers.weight[first]);
    WideInts const groups = load_lanes<WideInts>(&layers.group[first]);
    WideFloats const depth = candidate.inverse_depth;
    WideFloats const limit = tolerance + same_surface * depth;
    WideInts const shows = candidate.weight > faint;
    WideFloats const ended = load_lanes<WideFloats>(&layers.ended[first]);
    WideInts const is_ended = (depth - ended <= limit) & (ended - depth <= limit);
    WideInts const is_firm = shows & candidate.is_firm & ~is_ended;
    if (has_ends) {
        WideInts const begins = candidate.ends & (ended < 0) & ~is_hidden(depth, tolerance, group, first, layers);
        store_lanes(begins ? depth : ended, &layers.ended[first]);
    }
    WideInts const was_firm = load_lanes<WideInts>(&layers.is_firm[first]);
    WideInts const joins = shows & (groups == group) & (depth - there <= limit) & (there - depth <= limit);
    WideInts const in_front = (depth > there + limit) | shows_loose_shadow(depth, limit, group, first, layers);
    WideInts const wins = shows & ((is_firm & ~was_firm) | (~(is_firm ^ was_firm) & in_front));
    WideInts const replaces = wins & ~joins;
    WideFloats const zero{};
    WideFloats const one = zero + 1;
    WideFloats const keep = replaces ? zero : one;
    WideFloats const take = (wins | joins) ? one : zero;
    store_lanes(keep * load_lanes<WideFloats>(&layers.red[first]) + take * candidate.red, &layers.red[first]);
    store_lanes(keep * load_lanes<WideFloats>(&layers.green[first]) + take * candidate.green, &layers.green[first]);
    store_lanes(keep * load_lanes<WideFloats>(&layers.blue[first]) + take * candidate.blue, &layers.blue[first]);
    store_lanes(keep * weight + take * candidate.weight, &layers.weight[first]);
    store_lanes(replaces ? depth : there, &layers.inverse_depth[first]);
    store_lanes(replaces ? WideInts{} + group : groups, &layers.group[first]);
    store_lanes(replaces ? is_firm : was_firm | (joins & is_firm), &layers.is_firm[first]);
    return any_lane(wins | joins);
}

/// True when nothing of the patch can show in so many rows of lanes, the first of which lies (x, y) from the centre of
/// its box's first pixel.
bool is_hidden(WarpPatch const& patch, float x, float y, int column, int first_row, int count, Layers const& layers) {
    WideFloats const from_left = x + __builtin_convertvector(wide_column, WideFloats);
    WideFloats const from_top = y + __builtin_convertvector(wide_row, WideFloats);
    WideInts shows{};
    for (int i = 0; i < count; ++i) {
        WideFloats const row = from_top + static_cast<float>(i * wide_rows);
        WideFloats const depth =
            (patch.inverse_depth + row * patch.inverse_depth_dy) + from_left * patch.inverse_depth_dx;
        shows |= ~is_hidden(depth, patch.tolerance, patch.group, index_of(column, first_row + i * wide_rows), layers);
    }
    return !any_lane(shows);
}

/// Makes candidates show only where nothing firm does.
void fade(std::span<Candidate> candidates) {
    constexpr float share = 0.1f;
    for (Candidate& candidate : candidates) {
        candidate.is_firm = WideInts{};
        for (WideFloats* const sum : {&candidate.red, &candidate.green, &candidate.blue, &candidate.weight}) {
            *sum *= share;
        }
    }
}

/// Paints the patch of a layer; true when something of it shows.
bool paint_layer(WarpPatch const& patch, int left, int top, Layers& layers) {
    bool shows = false;
    CandidateColumn column;
    int const first_row = std::max(patch.box.top - top, 0) / wide_rows * wide_rows;
    int const last_row = std::min(patch.box.bottom - top, side);
    int const count = (last_row - first_row + wide_rows - 1) / wide_rows;
    int const last = std::min(patch.box.right - left, side);
    for (int x = std::max(patch.box.left - left, 0) / wide_columns * wide_columns; x < last; x += wide_columns) {
        float const from_left = static_cast<float>(left + x - patch.box.left);
        float const from_top = static_cast<float>(top + first_row - patch.box.top);
        if (is_hidden(patch, from_left, from_top, x, first_row, count, layers) ||
            !may_show(patch, from_left, from_top, count)) {
            continue;
        }
        sample_patch(patch, from_left, from_top, count, column);
        if (!patch.hides) {
            fade(std::span(column).first(static_cast<std::size_t>(count)));
        }
        for (int i = 0; i < count; ++i) {
            shows |= merge(column[static_cast<std::size_t>(i)], patch.group, patch.tolerance,
                           index_of(x, first_row + i * wide_rows), patch.has_ends, layers);
        }
    }
    return shows;
}

/// Fetches from memory about the rows of the grid that painting will read.
void prefetch_grid(WarpPatch const& patch, int left, int top) {
    constexpr int line = 64 / sizeof(PackedSample);
    auto const x = static_cast<float>(std::max(left - patch.box.left, 0));
    int const first_row = std::max(top - patch.box.top, 0);
    int const last_row = std::min(top + side, patch.box.bottom) - patch.box.top;
    float const step = 1 / std::max(patch.at[2], 1e-3f);
    float const u = (patch.at[0] + x * patch.dx[0]) * step;
    float const v = (patch.at[1] + x * patch.dx[1]) * step;
    float const last = static_cast<float>(patch.side - 1);
    int const column = static_cast<int>(std::clamp(u, 0.0f, last));
    int const from = static_cast<int>(std::clamp(v + static_cast<float>(first_row) * patch.dy[1] * step, 0.0f, last));
    int const to = static_cast<int>(std::clamp(v + static_cast<float>(last_row) * patch.dy[1] * step, 0.0f, last));
    PackedSample const* const grid = patch.grid + column;
    for (int row = from; row <= to; ++row) {
        __builtin_prefetch(grid + row * patch.stride);
        __builtin_prefetch(grid + row * patch.stride + line);
    }
}

/// Weights of a tent: 1 at no distance, falling to 0 at 1 / scale.
WideFloats tent(WideFloats distance, float scale) {
    return larger(1 - larger(distance, -distance) * scale, WideFloats{});
}

/// True when the pixel nearest to the splat's middle is covered firmly, by what is near enough and no part of what the
/// splat adds up with: most of the splat is hidden then.
bool is_hidden(Splat const& splat, std::int32_t group, int left, int top, Layers const& layers) {
    auto const pixel = [](float at, int from) {
        return static_cast<int>(std::clamp(at - static_cast<float>(from), 0.0f, side - 1.0f));
    };
    std::size_t const at = index_of(pixel(splat.x, left), pixel(splat.y, top));
    float const there = layers.inverse_depth[at];
    bool const is_loose =
        is_drifting(layers.group[at]) && !is_drifting(group) && there > (1 + same_surface) * splat.inverse_depth;
    return layers.is_firm[at] != 0 && layers.group[at] != group && there >= (1 - same_surface) * splat.inverse_depth &&
           !is_loose;
}

/// True where the tent of a splat has columns in the block.
bool reaches(Splat const& splat, int left) {
    float const x = splat.x - static_cast<float>(left) - 0.5f;
    return x + splat.spacing >= 0 && x - splat.spacing <= side - 1;
}

/// Paints an outlier as a tent as wide as its neighbours are far; true when something of it shows.
bool paint_splat(Splat const& splat, std::int32_t group, int left, int top, Layers& layers) {
    float const x = splat.x - static_cast<float>(left) - 0.5f;
    float const y = splat.y - static_cast<float>(top) - 0.5f;
    float const scale = 1 / splat.spacing;
    int const first_row = static_cast<int>(std::ceil(std::max(y - splat.spacing, 0.0f)));
    int const last_row = static_cast<int>(std::floor(std::min(y + splat.spacing, side - 1.0f)));
    bool shows = false;
    WideFloats const zero{};
    Candidate some;
    for (int from = 0; from < side; from += wide_columns) {
        if (x + splat.spacing < static_cast<float>(from) ||
            x - splat.spacing > static_cast<float>(from + wide_columns - 1)) {
            continue;
        }
        WideFloats const wx = tent(__builtin_convertvector(wide_column + from, WideFloats) - x, scale);
        for (int j = first_row / wide_rows * wide_rows; j <= last_row; j += wide_rows) {
            some.weight = wx * tent(__builtin_convertvector(wide_row + j, WideFloats) - y, scale);
            some.red = some.weight * square(red_of(splat.sample));
            some.green = some.weight * square(green_of(splat.sample));
            some.blue = some.weight * square(blue_of(splat.sample));
            some.inverse_depth = zero + splat.inverse_depth;
            some.is_firm = some.weight >= firm_tent;
            shows |= merge(some, group, 0, index_of(from, j), false, layers);
        }
    }
    return shows;
}

/// Paints a patch; true when something of it shows.
bool paint_patch(PatchView const& view, int left, int top, Layers& layers) {
    WarpPatch const& patch = *view.patch;
    layers.has_shadows = layers.has_shadows || is_drifting(patch.group);
    if (!patch.is_outlier) {
        return paint_layer(patch, left, top, layers);
    }
    std::span<Splat const> const splats(view.splats + patch.first_splat, patch.splats);
    std::bitset<framelet_samples> painted; // what is hidden is so by what was there before all of them
    for (std::size_t k = 0; k < splats.size(); ++k) {
        painted[k] = reaches(splats[k], left) && !is_hidden(splats[k], patch.group, left, top, layers);
    }
    bool shows = false;
    for (std::size_t k = 0; k < splats.size(); ++k) {
        shows |= painted[k] && paint_splat(splats[k], patch.group, left, top, layers);
    }
    return shows;
}

/// Stores values that lie together in `Layers` into the rows of a block.
template <class Lanes, class T>
void store_pixels(Lanes const& values, int x, int y, std::array<T, pixels>& plane) {
    T* const to = &plane[static_cast<std::size_t>(y * side + x)];
#ifdef __AVX512F__
    store_lanes(__builtin_shufflevector(values, values, 0, 1, 2, 3, 4, 5, 6, 7), to);
    store_lanes(__builtin_shufflevector(values, values, 8, 9, 10, 11, 12, 13, 14, 15), to + side);
#else
    store_lanes(values, to);
#endif
}

/// Divides the sums by their weights and counts the holes.
void finish(Layers const& layers, int width, int height, WarpedBlock& block) {
    WideFloats const zero{};
    WideInts holes{};
    for (int x = 0; x < side; x += wide_columns) {
        for (int y = 0; y < side; y += wide_rows) {
            std::size_t const i = index_of(x, y);
            WideFloats const weight = load_lanes<WideFloats>(&layers.weight[i]);
            WideInts const shows = weight > 0;
            WideFloats const scale = shows ? 1 / weight : zero;
            store_pixels(scale * load_lanes<WideFloats>(&layers.red[i]), x, y, block.squares[0]);
            store_pixels(scale * load_lanes<WideFloats>(&layers.green[i]), x, y, block.squares[1]);
            store_pixels(scale * load_lanes<WideFloats>(&layers.blue[i]), x, y, block.squares[2]);
            store_pixels(shows ? load_lanes<WideFloats>(&layers.inverse_depth[i]) : zero + hole_depth, x, y,
                         block.inverse_depth);
            store_pixels(load_lanes<WideInts>(&layers.group[i]), x, y, block.group);
            holes -= (wide_column < width - x) & (wide_row < height - y) & ~shows;
        }
    }
    block.holes = 0;
    for (int k = 0; k < wide_count; ++k) {
        block.holes += holes[k];
    }
}

/// Pixels of a block that are enough for a patch to be worth keeping.
constexpr int enough_pixels = 6;

bool shows_enough(std::int32_t group, Layers const& layers) {
    WideInts count{};
    for (std::size_t i = 0; i < pixels; i += wide_count) {
        count -= load_lanes<WideInts>(&layers.group[i]) == group;
    }
    int sum = 0;
    for (int k = 0; k < wide_count; ++k) {
        sum += count[k];
    }
    return sum >= enough_pixels;
}

/// Notes that a patch shows; other blocks may note the same at the same time.
void note_shown(PatchView const& view) {
    std::atomic_ref(*view.shows).store(1, std::memory_order_relaxed);
}

} // namespace

void paint_warped_block(std::span<PatchView const> patches, int column, int row, Viewport viewport,
                        WarpedBlock& block) {
    Layers layers;
    for (auto* const plane : {&layers.red, &layers.green, &layers.blue, &layers.weight}) {
        plane->fill(0);
    }
    layers.inverse_depth.fill(hole_depth);
    layers.group.fill(-1);
    layers.is_firm.fill(0);
    layers.ended.fill(-1e30f);
    int const left = column * side;
    int const top = row * side;
    constexpr std::size_t most_claims = 64;
    std::uint64_t claims = 0; // bits of patches of which something showed when they were painted
    for (std::size_t i = 0; i < patches.size(); ++i) {
        if (i + 1 < patches.size()) {
            prefetch_grid(*patches[i + 1].patch, left, top);
        }
        if (!paint_patch(patches[i], left, top, layers)) {
            continue;
        }
        if (i < most_claims) {
            claims |= std::uint64_t{1} << i;
        } else {
            note_shown(patches[i]);
        }
    }
    for (; claims != 0; claims &= claims - 1) {
        PatchView const& view = patches[static_cast<std::size_t>(std::countr_zero(claims))];
        if (shows_enough(view.patch->group, layers)) {
            note_shown(view);
        }
    }
    finish(layers, viewport.width - left, viewport.height - top, block);
}

} // namespace framelet
