// Levels of sampling: how finely a place of the picture is sampled, each four times as finely as the one before.
#pragma once

#include <array>
#include <cstddef>

#include "common/framelet/tile.h"

namespace framelet {

/// Levels of sampling, from the coarsest tiles (0) over one sample a pixel to the finest.
inline constexpr int sampling_levels = coarsest_levels + 1 + finest_levels;
inline constexpr int pixel_level = coarsest_levels;
inline constexpr int finest_level = sampling_levels - 1;

/// Samples per pixel of a level: 1/64 .. 16.
constexpr float samples_per_pixel(int level) {
    constexpr std::array<float, sampling_levels> of_level{1.0f / 64, 1.0f / 16, 1.0f / 4, 1, 4, 16};
    return of_level[static_cast<std::size_t>(level)];
}

/// Pixels between the samples of a level.
constexpr float spacing_of(int level) {
    constexpr std::array<float, sampling_levels> of_level{8, 4, 2, 1, 1.0f / 2, 1.0f / 4};
    return of_level[static_cast<std::size_t>(level)];
}

} // namespace framelet
