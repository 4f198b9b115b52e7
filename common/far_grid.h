// Squares of cells, each with the mean of what is farthest in it, and how coarser cells come of finer ones (pull-push,
// 000 section 3.3): what a moving edge uncovers belongs to the background.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace framelet {

/// Mean of the farthest of several pixels: squares of sRGB-encoded values as in `WarpedBlock`.
struct FarMean {
    static constexpr float nothing = 1e30f;

    float red = 0, green = 0, blue = 0;
    float inverse_depth = nothing; ///< `nothing` where there is nothing to take a mean of

    bool operator==(FarMean const&) const = default;
};

constexpr bool is_nothing(float inverse_depth) {
    return inverse_depth >= FarMean::nothing;
}

/// n x n cells in rows.
template <int n>
struct FarGrid {
    static constexpr std::size_t cells = static_cast<std::size_t>(n * n);
    alignas(16) std::array<float, cells> red, green, blue, inverse_depth;
};

template <int n>
FarMean mean_at(FarGrid<n> const& grid, std::size_t i) {
    return {grid.red[i], grid.green[i], grid.blue[i], grid.inverse_depth[i]};
}

template <int n>
void put(FarMean const& mean, std::size_t i, FarGrid<n>& grid) {
    grid.red[i] = mean.red;
    grid.green[i] = mean.green;
    grid.blue[i] = mean.blue;
    grid.inverse_depth[i] = mean.inverse_depth;
}

/// What is so much nearer than the farthest of its neighbours does not spread: a share and, for the sky, 1 / metres.
inline constexpr float foreground_share = 1.15f;
inline constexpr float foreground_least = 1e-4f;

/// The weighted mean of those of four that are about as far as the farthest.
struct FarthestOfFour {
    std::array<float, 4> take;
    float scale;
    float farthest;

    FarthestOfFour(std::array<float, 4> const& weights, float a, float b, float c, float d)
        : farthest(std::min(std::min(a, b), std::min(c, d))) {
        float const limit = farthest * foreground_share + foreground_least;
        take = {a <= limit ? weights[0] : 0.0f, b <= limit ? weights[1] : 0.0f, c <= limit ? weights[2] : 0.0f,
                d <= limit ? weights[3] : 0.0f};
        scale = 1 / (take[0] + take[1] + take[2] + take[3]);
    }
    float mean(float a, float b, float c, float d) const {
        return scale * ((take[0] * a + take[1] * b) + (take[2] * c + take[3] * d));
    }
};

/// Cells of twice the side, each of the farthest of four.
template <int n>
void pull(FarGrid<2 * n> const& fine, FarGrid<n>& coarse) {
    for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x) {
            auto const to = static_cast<std::size_t>(y * n + x);
            auto const from = static_cast<std::size_t>(4 * y * n + 2 * x);
            std::size_t const below = from + 2 * n;
            FarthestOfFour const four({1, 1, 1, 1}, fine.inverse_depth[from], fine.inverse_depth[from + 1],
                                      fine.inverse_depth[below], fine.inverse_depth[below + 1]);
            coarse.red[to] = four.mean(fine.red[from], fine.red[from + 1], fine.red[below], fine.red[below + 1]);
            coarse.green[to] =
                four.mean(fine.green[from], fine.green[from + 1], fine.green[below], fine.green[below + 1]);
            coarse.blue[to] = four.mean(fine.blue[from], fine.blue[from + 1], fine.blue[below], fine.blue[below + 1]);
            coarse.inverse_depth[to] = four.farthest;
        }
    }
}

} // namespace framelet
