// Sums over the squares of n x n samples of a framelet in rows, to show it at fewer samples than it has.
#pragma once

#include <array>
#include <cstddef>

#include "common/framelet/tile.h"

namespace framelet {

/// Sums `values` over each square of n x n. `n`: 2, 4, 8 or 16; as many of `sums` are set as there are squares.
inline void box_sums(std::array<float, framelet_samples> const& values, std::size_t n,
                     std::array<float, framelet_samples / 4>& sums) {
    constexpr std::size_t side = framelet_side;
    std::size_t const boxes = side / n; // along a side
    for (std::size_t y = 0; y < boxes; ++y) {
        std::array<float, side> columns{};
        for (std::size_t j = 0; j < n; ++j) {
            for (std::size_t i = 0; i < side; ++i) {
                columns[i] += values[(y * n + j) * side + i];
            }
        }
        for (std::size_t x = 0; x < boxes; ++x) {
            float sum = 0;
            for (std::size_t i = 0; i < n; ++i) {
                sum += columns[x * n + i];
            }
            sums[y * boxes + x] = sum;
        }
    }
}

} // namespace framelet
