// The parts of a plan: where a layer of a framelet or its outliers show in the display picture.
#pragma once

#include <array>
#include <cstdint>

#include "common/held/framelet_cache.h"

namespace framelet {

/// Number of a group of samples: those of the same view, the same scene time and the same spacing. `slot`: that of the
/// pool.
constexpr std::int32_t group_of(std::size_t slot, std::uint32_t view, int depth) {
    return static_cast<std::int32_t>(slot << 24 | view << 4) + depth;
}
inline constexpr std::int32_t drifting_bit = 1 << 30;
/// The group of what drifts over the surface that it lies on (a shadow): it adds up with its like only, not with what
/// it comes over.
constexpr std::int32_t drifting_group(std::int32_t group) {
    return group | drifting_bit;
}
constexpr bool is_drifting(std::int32_t group) {
    return group >= 0 && (group & drifting_bit) != 0;
}
/// Bit that is set in the group of samples that lie on their own pixels, which those that have moved do not.
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
    float inverse_depth = 0, inverse_depth_dx = 0, inverse_depth_dy = 0; ///< likewise in the display, 1 / metres
    float worn = 0; ///< what its samples are worth: `worn_spacing` in the middle of the box, in steps; least is best
    float tolerance = 0; ///< difference of inverse depths, 1 / metres, within which they mean the same
    PixelRect box; ///< pixels of the display that hold all of it, clipped to the viewport
    PackedSample const* grid = nullptr;
    std::int32_t side = 0; ///< samples along a side of the grid
    std::int32_t stride = 0; ///< samples from one of the grid's rows to the next
    std::uint32_t layer = 0; ///< number of its samples in the grid
    LayerSet ends_before{}; ///< layers beside whose samples it ends, since they are farther
    bool has_ends = false; ///< `ends_before` is not empty
    /// A bit for each of 8x8 equal parts of the grid, in rows, in which there may be samples of it.
    std::uint64_t occupied = ~std::uint64_t{0};
    std::int32_t group = 0; ///< its samples are interpolated with others of the same group
    std::uint32_t first_splat = 0, splats = 0; ///< of outliers, among those of its square
    std::uint32_t tile_layer = 0; ///< by tile code, then layer: orders patches of one batch
    std::uint32_t square = 0; ///< number of its square in the plan, as `WarpPlan::square_grid` counts them
    std::uint64_t batch = 0;
    std::uint64_t signature = 0; ///< differs where what is painted may differ
    bool hides = true; ///< hides what is behind it; else it shows only where nothing does that hides
    bool is_outlier = false; ///< not a layer, but splats
    bool is_still = false; ///< its samples lie on their own pixels
};

/// An outlier in the display picture.
struct Splat {
    float x = 0, y = 0; ///< pixels
    float inverse_depth = 0; ///< in the display, 1 / metres
    float spacing = 0; ///< distance of its neighbours, pixels of the display
    PackedSample sample = 0;
};

/// A patch and the splats of its square.
struct PatchView {
    WarpPatch const* patch = nullptr;
    Splat const* splats = nullptr;
    std::uint8_t* shows = nullptr; ///< where 1 is noted if enough of it shows in the picture
    std::uint64_t rank = 0; ///< of its samples: the best ones, and of equals the newest, have the least
};

} // namespace framelet
