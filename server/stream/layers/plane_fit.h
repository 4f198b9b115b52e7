// Fits planes through values on a framelet's grid, by least squares over any part of its samples. In: values and which
// samples take part. Out: planes, and how far the samples lie off them.
#pragma once

#include <array>

#include "common/framelet/tile.h"

namespace framelet {

/// The grid in blocks of 4x4 samples, 16 contiguous ones in Morton order.
inline constexpr int grid_blocks = 16;
inline constexpr int block_samples = framelet_samples / grid_blocks;

/// One number a sample in block order: `block_order` of sample k of block b is 16 * k + b, so that loops over sixteen
/// blocks become vector instructions.
struct alignas(64) GridFloats {
    float value[framelet_samples];

    constexpr float& operator[](int i) { return value[i]; }
    constexpr float operator[](int i) const { return value[i]; }
};
constexpr int block_order(int morton) {
    return (morton % block_samples) * grid_blocks + morton / block_samples;
}

/// Puts values of samples, which are in Morton order, into block order.
void to_block_order(std::array<float, framelet_samples> const& morton, GridFloats& out);

/// Column and row of the sample at a position in block order, from the middle of the grid: -7.5 .. 7.5.
struct GridCoordinates {
    GridFloats x, y;
};
extern GridCoordinates const grid_coordinates;

/// value = centre + dx * x + dy * y, with x and y as in `grid_coordinates`.
struct GridPlane {
    float centre = 0, dx = 0, dy = 0;
};

/// Value of the sample at position i in block order minus the plane.
inline float residual(GridFloats const& values, GridPlane const& plane, int i) {
    return values[i] - (plane.centre + plane.dx * grid_coordinates.x[i] + plane.dy * grid_coordinates.y[i]);
}

/// The largest value, 0 at least.
float greatest(GridFloats const& values);

/// Sums over samples: their number, coordinates, values, and products of those.
struct Moments {
    float n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0, w = 0, wx = 0, wy = 0;
};

/// Sums of every block, and of the whole grid.
struct BlockMoments {
    std::array<Moments, grid_blocks> block;
    Moments total;
};

/// Sums with weights: 0 leaves a sample out.
Moments moments_of(GridFloats const& values, GridFloats const& weights);
BlockMoments block_moments_of(GridFloats const& values, GridFloats const& weights);
/// The least-squares plane. Across the direction in which the samples do not spread it is level. Finite for finite
/// sums.
GridPlane least_squares(Moments const& moments);

/// Smallest and largest of value - plane over the samples of non-zero weight; both 0 where there are none.
struct Range {
    float least = 0, most = 0;

    float half_width() const { return 0.5f * (most - least); }
    float middle() const { return 0.5f * (most + least); }
};
Range residual_range(GridFloats const& values, GridFloats const& weights, GridPlane const& plane);

/// The least-squares plane of the whole grid, moved so that it is as far off to both sides.
struct FittedPlane {
    GridPlane plane;
    float half_width = 0; ///< how far off the farthest samples are, to both sides
};
FittedPlane fit_plane_to_all(GridFloats const& values);

/// Sets `members` to 1 where a sample of non-zero weight is within `tolerance` of the plane, else to 0. Returns how
/// many there are.
int find_members(GridFloats const& values, GridFloats const& weights, GridPlane const& plane, float tolerance,
                 GridFloats& members);

} // namespace framelet
