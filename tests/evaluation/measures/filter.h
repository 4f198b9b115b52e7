// Applies separable filters to planes of floats, for SSIM and FLIP. In: a plane, two kernels. Out: a plane of the same
// size, the border repeated outwards.
#pragma once

#include <span>
#include <vector>

namespace framelet::bench {

struct Plane {
    int width = 0, height = 0;
    std::vector<float> values; ///< rows from the top

    Plane(int w, int h) : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
};

/// Correlates rows with `across` and columns with `down`; both of odd length, centred.
Plane filter(Plane const& plane, std::span<float const> across, std::span<float const> down);

} // namespace framelet::bench
