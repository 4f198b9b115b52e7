// What a plan consists of: where a layer of a framelet or its outliers show in the display picture.
#pragma once

#include <array>
#include <cstdint>

#include "common/held/framelet_cache.h"

namespace framelet {

/// Of the same view, the same scene time and the same spacing. `slot`: of the pool.
constexpr std::int32_t group_of(std::size_t slot, std::uint32_t view, int depth) {
    return static_cast<std::int32_t>(slot << 24 | view << 4) + depth;
}
/// What drifts over the surface that it lies on (a shadow) adds up with its like only, not with what it comes over.
constexpr std::int32_t drifting_group(std::int32_t group) {
    return group | 1 << 30;
}
/// Set in the group of samples that lie on their own pixels, which those that have moved do not.
inline constexpr std::int32_t still_bit = 1 << 29;
constexpr std::int32_t still_group(std::int32_t group) {
    return group | still_bit;
}
constexpr std::size_t slot_of_group(std::int32_t group) {
    return static_cast<std::uint32_t>(group) >> 24 & 0x1fu;
}
constexpr std::uint32_t view_of_group(std::int32_t group) {
    return static_cast<std::uint32_t>(group) >> 4 & 0xfffffu;
}
constexpr int depth_of_group(std::int32_t group) {
    return group % 16;
}

/// A layer of a framelet in the display picture, or its outliers.
struct WarpPatch {
    /// Homogeneous sample coordinates (u / z, v / z, 1 / z) of the moving grid at the centre of the box's first pixel,
    /// and what a pixel to the right and one down add. Sample (i, j) lies at u = i, v = j.
    std::array<float, 3> at{}, dx{}, dy{};
    float inverse_depth = 0, inverse_depth_dx = 0, inverse_depth_dy = 0; ///< the same of the display's, 1 / metres
    float worn = 0; ///< what its samples are worth: `worn_spacing` in the middle of the box
    float tolerance = 0; ///< by which inverse depths may differ though they mean the same
    PixelRect box; ///< that holds all of it, clipped to the viewport
    PackedSample const* grid = nullptr;
    std::int32_t side = 0; ///< of the grid
    std::int32_t stride = 0; ///< from one of its rows to the next
    std::uint32_t layer = 0; ///< number of its samples in the grid
    LayerSet ends_before{}; ///< beside the samples of these it ends: they are farther
    bool has_ends = false; ///< there are some
    /// Of 8x8 equal parts of the grid, in rows, those in which there may be samples of it.
    std::uint64_t occupied = ~std::uint64_t{0};
    std::int32_t group = 0; ///< its samples are interpolated with others' of the same
    std::uint32_t first_splat = 0, splats = 0; ///< of outliers, in the chunk
    std::uint32_t place = 0; ///< by tile and layer: orders patches of one batch
    std::uint32_t square = 0; ///< of the plan, as `WarpPlan::square_grid` counts them
    std::uint64_t batch = 0;
    std::uint64_t signature = 0; ///< differs where what is painted may differ
    bool hides = true; ///< what is behind it; else it shows only where nothing does that hides
    bool is_outlier = false; ///< not a layer, but splats
    bool is_still = false; ///< its samples lie on their own pixels
};

/// An outlier in the display picture.
struct Splat {
    float x = 0, y = 0; ///< pixels
    float inverse_depth = 0; ///< in the display
    float spacing = 0; ///< distance of its neighbours, pixels of the display
    PackedSample sample = 0;
};

/// A patch and the splats of its chunk.
struct PatchView {
    WarpPatch const* patch = nullptr;
    Splat const* splats = nullptr;
    std::uint8_t* shows = nullptr; ///< set where enough of it shows in the picture; null: nobody asks
    std::uint64_t rank = 0; ///< of its samples: the best ones, and of those the newest, have the least
};

} // namespace framelet
