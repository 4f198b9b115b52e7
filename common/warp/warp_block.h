// Paints one block of a moved picture from its patches: samples of one layer are interpolated with each other, never
// with another layer's; what is nearer hides what is behind it, and of one surface the best samples show. In: patches,
// the best first. Out: colour and inverse depth of 16x16 pixels.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "common/warp/warp_plan.h"

namespace framelet {

/// Inverse depth of a pixel that nothing shows.
inline constexpr float hole_depth = -1;

/// A block's pixels in rows.
struct WarpedBlock {
    static constexpr int side = FrameletCache::block_side;
    static constexpr std::size_t pixels = static_cast<std::size_t>(side * side);

    /// Red, green, blue: squares of sRGB-encoded values, [0, 255^2]. Squares stand for linear light: weights act on
    /// them nearly as on light (at most 0.04 of full light away), and bytes come back exactly.
    std::array<std::array<float, pixels>, 3> squares;
    std::array<float, pixels> inverse_depth; ///< 1 / metres; `hole_depth` in holes, where the colour is 0
    std::array<std::int32_t, pixels> group; ///< of the patch that shows, as `WarpPatch::group`; -1 in holes
    int holes = 0;
};

/// Paints the block in column and row; pixels outside of the viewport become holes that are not counted.
///
/// Where samples are coarser than pixels they are interpolated bilinearly (a tent of radius one sample), across
/// framelets of the same view, time and spacing. A layer covers the cells of its samples enlarged by half a sample, so
/// that neighbours overlap; but where the nearest sample is another layer's it covers only what nothing else does, and
/// where that one is farther, worse samples of the same surface do likewise.
void paint_warped_block(std::span<PatchView const> patches, int column, int row, Viewport viewport, WarpedBlock& block);

} // namespace framelet
