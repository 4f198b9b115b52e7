#include "server/layers/plane_fit.h"

#include <algorithm>
#include <cmath>

namespace framelet {
namespace {

constexpr GridCoordinates make_grid_coordinates() {
    GridCoordinates grid{};
    constexpr float middle = 0.5f * (framelet_side - 1);
    for (int i = 0; i < framelet_samples; ++i) {
        grid.x[block_order(i)] = static_cast<float>(morton_x(static_cast<std::uint32_t>(i))) - middle;
        grid.y[block_order(i)] = static_cast<float>(morton_y(static_cast<std::uint32_t>(i))) - middle;
    }
    return grid;
}

/// One accumulator a lane; lanes are blocks.
struct alignas(64) Lanes {
    float lane[grid_blocks]{};

    float sum() const {
        float total = 0;
        for (float const value : lane) {
            total += value;
        }
        return total;
    }
};

struct LaneMoments {
    Lanes n, x, y, xx, xy, yy, w, wx, wy;
};

void add_up(GridFloats const& values, GridFloats const& weights, LaneMoments& sums) {
    for (int first = 0; first < framelet_samples; first += grid_blocks) {
        for (int b = 0; b < grid_blocks; ++b) {
            int const i = first + b;
            float const weight = weights[i], x = grid_coordinates.x[i], y = grid_coordinates.y[i];
            float const value = weight * values[i];
            sums.n.lane[b] += weight;
            sums.x.lane[b] += weight * x;
            sums.y.lane[b] += weight * y;
            sums.xx.lane[b] += weight * (x * x);
            sums.xy.lane[b] += weight * (x * y);
            sums.yy.lane[b] += weight * (y * y);
            sums.w.lane[b] += value;
            sums.wx.lane[b] += value * x;
            sums.wy.lane[b] += value * y;
        }
    }
}

Moments total_of(LaneMoments const& sums) {
    return {sums.n.sum(),  sums.x.sum(), sums.y.sum(),  sums.xx.sum(), sums.xy.sum(),
            sums.yy.sum(), sums.w.sum(), sums.wx.sum(), sums.wy.sum()};
}

} // namespace

constinit GridCoordinates const grid_coordinates = make_grid_coordinates();

float greatest(GridFloats const& values) {
    Lanes most;
    for (int first = 0; first < framelet_samples; first += grid_blocks) {
        for (int b = 0; b < grid_blocks; ++b) {
            float const value = values[first + b];
            most.lane[b] = value > most.lane[b] ? value : most.lane[b];
        }
    }
    return *std::max_element(most.lane, most.lane + grid_blocks);
}

Moments moments_of(GridFloats const& values, GridFloats const& weights) {
    LaneMoments sums;
    add_up(values, weights, sums);
    return total_of(sums);
}

BlockMoments block_moments_of(GridFloats const& values, GridFloats const& weights) {
    LaneMoments s;
    add_up(values, weights, s);
    BlockMoments out;
    for (std::size_t b = 0; b < grid_blocks; ++b) {
        out.block[b] = {s.n.lane[b],  s.x.lane[b], s.y.lane[b],  s.xx.lane[b], s.xy.lane[b],
                        s.yy.lane[b], s.w.lane[b], s.wx.lane[b], s.wy.lane[b]};
    }
    out.total = total_of(s);
    return out;
}

Moments moments_of_all(GridFloats const& values) {
    constexpr float variance = (framelet_side * framelet_side - 1) / 12.0f; // of a coordinate
    Lanes w, wx, wy;
    for (int first = 0; first < framelet_samples; first += grid_blocks) {
        for (int b = 0; b < grid_blocks; ++b) {
            float const value = values[first + b];
            w.lane[b] += value;
            wx.lane[b] += value * grid_coordinates.x[first + b];
            wy.lane[b] += value * grid_coordinates.y[first + b];
        }
    }
    constexpr float spread = framelet_samples * variance;
    return {framelet_samples, 0, 0, spread, 0, spread, w.sum(), wx.sum(), wy.sum()};
}

GridPlane least_squares(Moments const& m) {
    if (!(m.n > 0)) {
        return {};
    }
    float const mean_x = m.x / m.n, mean_y = m.y / m.n, mean = m.w / m.n;
    float const xx = m.xx - m.x * mean_x, xy = m.xy - m.x * mean_y, yy = m.yy - m.y * mean_y;
    float const wx = m.wx - m.w * mean_x, wy = m.wy - m.w * mean_y;
    float const determinant = xx * yy - xy * xy;
    float const spread = xx + yy;
    GridPlane plane;
    if (determinant > 1e-3f * spread * spread) {
        plane.dx = (wx * yy - wy * xy) / determinant;
        plane.dy = (wy * xx - wx * xy) / determinant;
    } else if (spread > 0.1f) { // all on a line, or nearly: the slope along it
        float const along_x = xx >= yy ? xx : xy, along_y = xx >= yy ? xy : yy;
        float const squared = along_x * along_x + along_y * along_y;
        float const slope = (wx * along_x + wy * along_y) / (squared * spread);
        plane.dx = slope * along_x;
        plane.dy = slope * along_y;
    }
    plane.centre = mean - plane.dx * mean_x - plane.dy * mean_y;
    return plane;
}

Range residual_range(GridFloats const& values, GridFloats const& weights, GridPlane const& plane) {
    Lanes least, most;
    std::fill_n(least.lane, grid_blocks, INFINITY);
    std::fill_n(most.lane, grid_blocks, -INFINITY);
    for (int first = 0; first < framelet_samples; first += grid_blocks) {
        for (int b = 0; b < grid_blocks; ++b) {
            float const off = residual(values, plane, first + b);
            bool const counts = weights[first + b] != 0;
            float const low = counts ? off : INFINITY, high = counts ? off : -INFINITY;
            least.lane[b] = low < least.lane[b] ? low : least.lane[b];
            most.lane[b] = high > most.lane[b] ? high : most.lane[b];
        }
    }
    Range const range{*std::min_element(least.lane, least.lane + grid_blocks),
                      *std::max_element(most.lane, most.lane + grid_blocks)};
    return range.least <= range.most ? range : Range{};
}

int find_members(GridFloats const& values, GridFloats const& weights, GridPlane const& plane, float tolerance,
                 GridFloats& members) {
    Lanes counts;
    for (int first = 0; first < framelet_samples; first += grid_blocks) {
        for (int b = 0; b < grid_blocks; ++b) {
            int const i = first + b;
            float const off = residual(values, plane, i);
            bool const near = (off <= tolerance) & (off >= -tolerance) & (weights[i] != 0);
            members[i] = near ? 1.0f : 0.0f;
            counts.lane[b] += members[i];
        }
    }
    return static_cast<int>(counts.sum());
}

} // namespace framelet
