#include "common/warp_block.h"

#include <algorithm>
#include <cmath>

#include "common/patch_sampling.h"

namespace framelet {

namespace {

constexpr int side = WarpedBlock::side;
constexpr int lanes = sampling_lanes;
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
    alignas(64) std::array<std::int32_t, pixels> group;
};

/// Lets candidates compete with what half a row of the block has. Of two that cover firmly or both do not, the
/// clearly nearer one wins; else the one that was there, which is newer. Those of one group on one surface add up.
void merge_row(Candidate const& row, std::int32_t group, float tolerance, std::size_t first, Layers& layers) {
    float* const red = layers.red.data() + first;
    float* const green = layers.green.data() + first;
    float* const blue = layers.blue.data() + first;
    float* const weight = layers.weight.data() + first;
    float* const inverse_depth = layers.inverse_depth.data() + first;
    std::int32_t* const groups = layers.group.data() + first;
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
    }
}

void paint_layer(WarpPatch const& patch, int left, int top, Layers& layers) {
    CandidateRows rows;
    int const first_row = std::max(patch.box.top - top, 0);
    int const row_count = std::min(patch.box.bottom - top, side) - first_row;
    for (int x = 0; x < side; x += lanes) {
        int const first = patch.box.left - left - x;
        int const last = patch.box.right - left - x;
        if (first >= lanes || last <= 0) {
            continue;
        }
        Candidate::Lanes<float> in_box;
        for (int i = 0; i < lanes; ++i) {
            in_box[static_cast<std::size_t>(i)] = ((i >= first) & (i < last)) ? 1.0f : 0.0f;
        }
        sample_patch(patch, static_cast<float>(-first), static_cast<float>(top + first_row - patch.box.top), row_count,
                     in_box, rows);
        for (int i = 0; i < row_count; ++i) {
            merge_row(rows[static_cast<std::size_t>(i)], patch.group, patch.tolerance,
                      static_cast<std::size_t>((first_row + i) * side + x), layers);
        }
    }
}

/// Loose samples: a tent each, as wide as its neighbours are far.
void paint_splat(Splat const& splat, std::int32_t group, int left, int top, Layers& layers) {
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
            merge_row(half, group, 0, static_cast<std::size_t>(j * side + from), layers);
        }
    }
}

/// Divides by the weights.
void finish(Layers const& layers, int width, int height, WarpedBlock& block) {
    for (std::size_t i = 0; i < pixels; ++i) {
        float const scale = layers.weight[i] > 0 ? 1 / layers.weight[i] : 0.0f;
        block.squares[0][i] = scale * layers.red[i];
        block.squares[1][i] = scale * layers.green[i];
        block.squares[2][i] = scale * layers.blue[i];
        block.inverse_depth[i] = layers.weight[i] > 0 ? layers.inverse_depth[i] : hole_depth;
    }
    block.holes = 0;
    for (int y = 0; y < std::min(height, side); ++y) {
        for (int x = 0; x < side; ++x) {
            block.holes += ((x < width) & !(layers.weight[static_cast<std::size_t>(y * side + x)] > 0)) ? 1 : 0;
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
    for (PatchView const& view : patches) {
        WarpPatch const& patch = *view.patch;
        if (patch.layer == FrameletShape::loose) {
            for (std::uint32_t k = 0; k < patch.splats; ++k) {
                paint_splat(view.splats[patch.first_splat + k], patch.group, left, top, layers);
            }
        } else {
            paint_layer(patch, left, top, layers);
        }
    }
    finish(layers, viewport.width - left, viewport.height - top, block);
}

} // namespace framelet
