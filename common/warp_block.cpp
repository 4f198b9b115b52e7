#include "common/warp_block.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace framelet {

namespace {

constexpr int side = WarpedBlock::side;
constexpr int lanes = side / 2; ///< pixels of a row that are worked on together: patches seldom begin where blocks do
constexpr std::size_t pixels = WarpedBlock::pixels;

/// Share of an interpolation that must come from a layer's own samples for it to cover what lies behind it.
constexpr float firm = 0.25f;
/// Less than this is no cover at all.
constexpr float faint = 1e-3f;
/// Inverse depths that differ by this share belong to one surface.
constexpr float same_surface = 0.01f;

/// What is in front at each pixel so far.
struct Layers {
    alignas(64) std::array<float, pixels> red, green, blue, weight, inverse_depth;
    alignas(64) std::array<std::int32_t, pixels> group, patch;
};

struct Candidate {
    alignas(64) std::array<float, lanes> red, green, blue, weight, inverse_depth;
};

/// Lets candidates compete with what half a row of the block has. Of two that cover firmly or both do not, the
/// clearly nearer one wins; else the one that was there, which is newer. Those of one group on one surface add up.
void merge_row(Candidate const& row, std::int32_t group, std::int32_t patch, float tolerance, std::size_t first,
               Layers& layers) {
    float* const red = layers.red.data() + first;
    float* const green = layers.green.data() + first;
    float* const blue = layers.blue.data() + first;
    float* const weight = layers.weight.data() + first;
    float* const inverse_depth = layers.inverse_depth.data() + first;
    std::int32_t* const groups = layers.group.data() + first;
    std::int32_t* const patches = layers.patch.data() + first;
#pragma GCC ivdep // rows of distinct arrays
    for (int i = 0; i < lanes; ++i) {
        auto const k = static_cast<std::size_t>(i);
        float const own = row.weight[k];
        float const depth = row.inverse_depth[k];
        float const there = inverse_depth[k];
        float const limit = tolerance + same_surface * depth;
        bool const shows = own > faint;
        bool const is_firm = own >= firm;
        bool const was_firm = weight[k] >= firm;
        bool const joins = shows & (groups[k] == group) & (std::abs(depth - there) <= limit);
        bool const wins = shows & ((is_firm & !was_firm) | ((is_firm == was_firm) & (depth > there + limit)));
        float const keep = (wins & !joins) ? 0.0f : 1.0f;
        float const take = (wins | joins) ? 1.0f : 0.0f;
        red[k] = keep * red[k] + take * row.red[k];
        green[k] = keep * green[k] + take * row.green[k];
        blue[k] = keep * blue[k] + take * row.blue[k];
        weight[k] = keep * weight[k] + take * own;
        bool const replaces = wins & !joins;
        inverse_depth[k] = replaces ? depth : there;
        groups[k] = replaces ? group : groups[k];
        patches[k] = replaces ? patch : patches[k];
    }
}

float square(std::uint32_t byte) {
    auto const value = static_cast<float>(static_cast<std::int32_t>(byte));
    return value * value;
}

/// The samples of a patch at half a row of pixels of which the first is (x, y) from the centre of the box's first
/// pixel.
void sample_row(WarpPatch const& patch, float x, float y, float first, float last, Candidate& out) {
    float const u0 = patch.at[0] + y * patch.dy[0] + x * patch.dx[0];
    float const v0 = patch.at[1] + y * patch.dy[1] + x * patch.dx[1];
    float const z0 = patch.at[2] + y * patch.dy[2] + x * patch.dx[2];
    float const w0 = patch.inverse_depth + y * patch.inverse_depth_dy + x * patch.inverse_depth_dx;
    float const du = patch.dx[0], dv = patch.dx[1], dz = patch.dx[2], dw = patch.inverse_depth_dx;
    PackedSample const* const grid = patch.grid;
    std::int32_t const n = patch.side;
    std::int32_t const end = n - 1;
    auto const outside = static_cast<float>(n);
    std::uint32_t const layer = patch.layer;
    for (int i = 0; i < lanes; ++i) {
        auto const k = static_cast<std::size_t>(i);
        auto const step = static_cast<float>(i);
        float const inverse_z = z0 + step * dz;
        float const z = 1 / inverse_z;
        float u = (u0 + step * du) * z;
        float v = (v0 + step * dv) * z;
        bool const inside =
            (inverse_z > 0) & (step >= first) & (step < last) & (u > -1) & (u < outside) & (v > -1) & (v < outside);
        u = inside ? u : 0;
        v = inside ? v : 0;
        float const fu = std::floor(u);
        float const fv = std::floor(v);
        auto const iu = static_cast<std::int32_t>(fu);
        auto const iv = static_cast<std::int32_t>(fv);
        float const right = u - fu;
        float const below = v - fv;
        std::int32_t const x0 = std::max(iu, 0);
        std::int32_t const x1 = std::min(iu + 1, end);
        std::int32_t const y0 = std::max(iv, 0) * n;
        std::int32_t const y1 = std::min(iv + 1, end) * n;
        float const scale = inside ? 1.0f : 0.0f;
        float const wx0 = iu >= 0 ? 1 - right : 0.0f;
        float const wx1 = iu < end ? right : 0.0f;
        float const wy0 = iv >= 0 ? scale - scale * below : 0.0f;
        float const wy1 = iv < end ? scale * below : 0.0f;
        PackedSample const s00 = grid[y0 + x0];
        PackedSample const s10 = grid[y0 + x1];
        PackedSample const s01 = grid[y1 + x0];
        PackedSample const s11 = grid[y1 + x1];
        float const a00 = layer_of(s00) == layer ? wx0 * wy0 : 0.0f;
        float const a10 = layer_of(s10) == layer ? wx1 * wy0 : 0.0f;
        float const a01 = layer_of(s01) == layer ? wx0 * wy1 : 0.0f;
        float const a11 = layer_of(s11) == layer ? wx1 * wy1 : 0.0f;
        out.weight[k] = (a00 + a10) + (a01 + a11);
        out.red[k] = (a00 * square(red_of(s00)) + a10 * square(red_of(s10))) +
                     (a01 * square(red_of(s01)) + a11 * square(red_of(s11)));
        out.green[k] = (a00 * square(green_of(s00)) + a10 * square(green_of(s10))) +
                       (a01 * square(green_of(s01)) + a11 * square(green_of(s11)));
        out.blue[k] = (a00 * square(blue_of(s00)) + a10 * square(blue_of(s10))) +
                      (a01 * square(blue_of(s01)) + a11 * square(blue_of(s11)));
        float const depth = w0 + step * dw;
        out.inverse_depth[k] = depth > 0 ? depth : 0.0f;
    }
}

void paint_layer(WarpPatch const& patch, std::int32_t index, int left, int top, Layers& layers) {
    Candidate half;
    int const last_row = std::min(patch.box.bottom - top, side);
    for (int x = 0; x < side; x += lanes) {
        auto const first = static_cast<float>(patch.box.left - left - x);
        auto const last = static_cast<float>(patch.box.right - left - x);
        if (first >= lanes || last <= 0) {
            continue;
        }
        for (int y = std::max(patch.box.top - top, 0); y < last_row; ++y) {
            sample_row(patch, static_cast<float>(left + x - patch.box.left),
                       static_cast<float>(top + y - patch.box.top), first, last, half);
            merge_row(half, patch.group, index, patch.tolerance, static_cast<std::size_t>(y * side + x), layers);
        }
    }
}

/// Loose samples: a tent each, as wide as its neighbours are far.
void paint_splat(Splat const& splat, WarpPatch const& patch, std::int32_t index, int left, int top, Layers& layers) {
    float const x = splat.x - static_cast<float>(left) - 0.5f;
    float const y = splat.y - static_cast<float>(top) - 0.5f;
    float const scale = 1 / splat.spacing;
    int const first_row = static_cast<int>(std::ceil(std::max(y - splat.spacing, 0.0f)));
    int const last_row = static_cast<int>(std::floor(std::min(y + splat.spacing, side - 1.0f)));
    if (x + splat.spacing < 0 || x - splat.spacing > side - 1) {
        return;
    }
    Candidate half;
    for (int from = 0; from < side; from += lanes) {
        if (x + splat.spacing < static_cast<float>(from) || x - splat.spacing > static_cast<float>(from + lanes - 1)) {
            continue;
        }
        for (int j = first_row; j <= last_row; ++j) {
            float const wy = std::max(1 - std::abs(static_cast<float>(j) - y) * scale, 0.0f);
            for (int i = 0; i < lanes; ++i) {
                auto const k = static_cast<std::size_t>(i);
                float const weight = wy * std::max(1 - std::abs(static_cast<float>(from + i) - x) * scale, 0.0f);
                half.weight[k] = weight;
                half.red[k] = weight * square(red_of(splat.sample));
                half.green[k] = weight * square(green_of(splat.sample));
                half.blue[k] = weight * square(blue_of(splat.sample));
                half.inverse_depth[k] = splat.inverse_depth;
            }
            merge_row(half, patch.group, index, 0, static_cast<std::size_t>(j * side + from), layers);
        }
    }
}

/// Divides by the weights and looks up where each pixel's sample came from.
void finish(std::span<PatchView const> patches, Layers const& layers, int width, int height, WarpedBlock& block) {
    for (std::size_t i = 0; i < pixels; ++i) {
        float const scale = layers.weight[i] > 0 ? 1 / layers.weight[i] : 0.0f;
        block.squares[0][i] = scale * layers.red[i];
        block.squares[1][i] = scale * layers.green[i];
        block.squares[2][i] = scale * layers.blue[i];
        block.inverse_depth[i] = layers.weight[i] > 0 ? layers.inverse_depth[i] : hole_depth;
    }
    std::vector<float> times(patches.size() + 1), stretches(patches.size() + 1); // by patch + 1; 0 for none
    for (std::size_t i = 0; i < patches.size(); ++i) {
        times[i + 1] = static_cast<float>(patches[i].patch->scene_time);
        stretches[i + 1] = patches[i].patch->stretch;
    }
    float const* const time = times.data();
    float const* const stretch = stretches.data();
    for (std::size_t i = 0; i < pixels; ++i) {
        block.scene_time[i] = time[layers.patch[i] + 1];
        block.stretch[i] = stretch[layers.patch[i] + 1];
    }
    block.holes = 0;
    for (int y = 0; y < std::min(height, side); ++y) {
        for (int x = 0; x < std::min(width, side); ++x) {
            block.holes += layers.patch[static_cast<std::size_t>(y * side + x)] < 0 ? 1 : 0;
        }
    }
}

} // namespace

void paint_warped_block(std::span<PatchView const> patches, int column, int row, Viewport viewport,
                        WarpedBlock& block) {
    int const left = column * side;
    int const top = row * side;
    Layers layers;
    for (auto* const plane : {&layers.red, &layers.green, &layers.blue, &layers.weight}) {
        plane->fill(0);
    }
    layers.inverse_depth.fill(hole_depth);
    layers.group.fill(-1);
    layers.patch.fill(-1);
    for (std::size_t i = 0; i < patches.size(); ++i) {
        WarpPatch const& patch = *patches[i].patch;
        auto const index = static_cast<std::int32_t>(i);
        if (patch.layer == FrameletShape::loose) {
            for (std::uint32_t k = 0; k < patch.splats; ++k) {
                paint_splat(patches[i].splats[patch.first_splat + k], patch, index, left, top, layers);
            }
        } else {
            paint_layer(patch, index, left, top, layers);
        }
    }
    finish(patches, layers, viewport.width - left, viewport.height - top, block);
}

} // namespace framelet
