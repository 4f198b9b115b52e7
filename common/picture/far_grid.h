// Squares of cells, each with the mean of what is farthest in it, and how coarser cells come of finer ones (pull-push,
// [Scherzer 2012] section 3.3): what a moving edge uncovers belongs to the background.
#pragma once

#include <array>
#include <cstddef>
#include <cstring>
#include <type_traits>

#include "common/simd/lanes.h"

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

/// A cell that is nearer by more than this than the farthest of its neighbours does not spread: a factor of inverse
/// depth and, for the sky, 1 / metres besides.
inline constexpr float foreground_share = 1.15f;
inline constexpr float foreground_least = 1e-4f;

/// The weighted mean of those of four cells that are about as far as the farthest. T: numbers or lanes of them.
template <class T>
struct FarthestOfFour {
    std::array<T, 4> take;
    T scale;
    T farthest;

    FarthestOfFour(std::array<float, 4> const& weights, T a, T b, T c, T d)
        : farthest(smaller(smaller(a, b), smaller(c, d))) {
        T const limit = farthest * foreground_share + foreground_least;
        T const zero{};
        take = {a <= limit ? zero + weights[0] : zero, b <= limit ? zero + weights[1] : zero,
                c <= limit ? zero + weights[2] : zero, d <= limit ? zero + weights[3] : zero};
        scale = 1 / (take[0] + take[1] + take[2] + take[3]);
    }
    T mean(T a, T b, T c, T d) const { return scale * ((take[0] * a + take[1] * b) + (take[2] * c + take[3] * d)); }
};

/// Makes cells of twice the side, each of the farthest of four.
template <int n>
void pull(FarGrid<2 * n> const& fine, FarGrid<n>& coarse) {
    constexpr int step = n % lane_count == 0 ? lane_count : n == 1 ? 1 : lane_count / 2;
    using T = std::conditional_t<step == lane_count, FloatLanes, std::conditional_t<step == 1, float, HalfFloats>>;
    static_assert(n % step == 0 || n * n == step);
    for (int i = 0; i < n * n; i += step) {
        // The four fine cells of each coarse one.
        auto const four_of = [&](std::array<float, FarGrid<2 * n>::cells> const& plane) {
            float const* const above = &plane[static_cast<std::size_t>(i / n * 4 * n + i % n * 2)];
            float const* const below = above + 2 * n;
            if constexpr (n == 1) {
                return std::array{above[0], above[1], below[0], below[1]};
            } else {
                constexpr int next = n < step ? 4 * n : step; // in the same row or that of the next coarse one
                auto const a = load_lanes<T>(above), b = load_lanes<T>(above + next);
                auto const c = load_lanes<T>(below), d = load_lanes<T>(below + next);
                return std::array{even_of(a, b), odd_of(a, b), even_of(c, d), odd_of(c, d)};
            }
        };
        auto const depths = four_of(fine.inverse_depth);
        FarthestOfFour<T> const four({1, 1, 1, 1}, depths[0], depths[1], depths[2], depths[3]);
        auto const put_mean = [&](auto const& from, auto& to) {
            auto const values = four_of(from);
            T const mean = four.mean(values[0], values[1], values[2], values[3]);
            std::memcpy(&to[static_cast<std::size_t>(i)], &mean, sizeof mean);
        };
        put_mean(fine.red, coarse.red);
        put_mean(fine.green, coarse.green);
        put_mean(fine.blue, coarse.blue);
        std::memcpy(&coarse.inverse_depth[static_cast<std::size_t>(i)], &four.farthest, sizeof four.farthest);
    }
}

} // namespace framelet
