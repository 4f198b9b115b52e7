#include "server/stream/layers/plane_fit.h"

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

#pragma GCC diagnostic ignored "-Wpsabi" // how processors without AVX would pass these matters to no other file

/// Eight blocks side by side. Spelt out because loops that end in sums over lanes do not become good vector code.
using Lanes = float __attribute__((vector_size(32), may_alias));
constexpr int lanes = sizeof(Lanes) / sizeof(float);

Lanes lanes_at(GridFloats const& values, int i) {
    return *reinterpret_cast<Lanes const*>(values.value + i);
}

float sum(Lanes const& values) {
    return ((values[0] + values[4]) + (values[1] + values[5])) + ((values[2] + values[6]) + (values[3] + values[7]));
}
float least_of(Lanes const& values) {
    float least = values[0];
    for (int lane = 1; lane < lanes; ++lane) {
        least = values[lane] < least ? values[lane] : least;
    }
    return least;
}
float greatest_of(Lanes const& values) {
    return -least_of(-values);
}

Lanes residuals(GridFloats const& values, GridPlane const& plane, int i) {
    return lanes_at(values, i) -
           (plane.centre + plane.dx * lanes_at(grid_coordinates.x, i) + plane.dy * lanes_at(grid_coordinates.y, i));
}

struct LaneMoments {
    Lanes n{}, x{}, y{}, xx{}, xy{}, yy{}, w{}, wx{}, wy{};
};

/// Sums of the blocks from `first`, eight of them.
LaneMoments add_up(GridFloats const& values, GridFloats const& weights, int first) {
    LaneMoments sums;
    for (int i = first; i < framelet_samples; i += grid_blocks) {
        Lanes const x = lanes_at(grid_coordinates.x, i), y = lanes_at(grid_coordinates.y, i);
        Lanes const weight = lanes_at(weights, i), value = weight * lanes_at(values, i);
        Lanes const weight_x = weight * x, weight_y = weight * y;
        sums.n += weight;
        sums.x += weight_x;
        sums.y += weight_y;
        sums.xx += weight_x * x;
        sums.xy += weight_x * y;
        sums.yy += weight_y * y;
        sums.w += value;
        sums.wx += value * x;
        sums.wy += value * y;
    }
    return sums;
}

/// Sums over the whole grid.
Moments moments_of_all(GridFloats const& values) {
    constexpr float variance = (framelet_side * framelet_side - 1) / 12.0f; // of a coordinate
    constexpr float spread = framelet_samples * variance;
    Lanes w{}, wx{}, wy{};
    for (int i = 0; i < framelet_samples; i += lanes) {
        Lanes const value = lanes_at(values, i);
        w += value;
        wx += value * lanes_at(grid_coordinates.x, i);
        wy += value * lanes_at(grid_coordinates.y, i);
    }
    return {framelet_samples, 0, 0, spread, 0, spread, sum(w), sum(wx), sum(wy)};
}

} // namespace

constinit GridCoordinates const grid_coordinates = make_grid_coordinates();

void to_block_order(std::array<float, framelet_samples> const& morton, GridFloats& out) {
    for (int block = 0; block < grid_blocks; ++block) {
        for (int i = 0; i < block_samples; ++i) {
            out[i * grid_blocks + block] = morton[static_cast<std::size_t>(block * block_samples + i)];
        }
    }
}

float greatest(GridFloats const& values) {
    Lanes most{};
    for (int i = 0; i < framelet_samples; i += lanes) {
        Lanes const value = lanes_at(values, i);
        most = value > most ? value : most;
    }
    return greatest_of(most);
}

Moments moments_of(GridFloats const& values, GridFloats const& weights) {
    Moments total;
    for (int first = 0; first < grid_blocks; first += lanes) {
        LaneMoments const s = add_up(values, weights, first);
        total.n += sum(s.n);
        total.x += sum(s.x);
        total.y += sum(s.y);
        total.xx += sum(s.xx);
        total.xy += sum(s.xy);
        total.yy += sum(s.yy);
        total.w += sum(s.w);
        total.wx += sum(s.wx);
        total.wy += sum(s.wy);
    }
    return total;
}

BlockMoments block_moments_of(GridFloats const& values, GridFloats const& weights) {
    BlockMoments out;
    Moments& total = out.total;
    for (int first = 0; first < grid_blocks; first += lanes) {
        LaneMoments const s = add_up(values, weights, first);
        for (int lane = 0; lane < lanes; ++lane) {
            Moments& block = out.block[static_cast<std::size_t>(first + lane)];
            block = {s.n[lane],  s.x[lane], s.y[lane],  s.xx[lane], s.xy[lane],
                     s.yy[lane], s.w[lane], s.wx[lane], s.wy[lane]};
            total = {total.n + block.n,   total.x + block.x,   total.y + block.y,
                     total.xx + block.xx, total.xy + block.xy, total.yy + block.yy,
                     total.w + block.w,   total.wx + block.wx, total.wy + block.wy};
        }
    }
    return out;
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
    Lanes const none = Lanes{} + INFINITY;
    Lanes least = none, most = -none;
    for (int i = 0; i < framelet_samples; i += lanes) {
        Lanes const off = residuals(values, plane, i);
        auto const counts = lanes_at(weights, i) != 0;
        Lanes const low = counts ? off : none, high = counts ? off : -none;
        least = low < least ? low : least;
        most = high > most ? high : most;
    }
    Range const range{least_of(least), greatest_of(most)};
    return range.least <= range.most ? range : Range{};
}

FittedPlane fit_plane_to_all(GridFloats const& values) {
    FittedPlane fitted{least_squares(moments_of_all(values))};
    Lanes least = residuals(values, fitted.plane, 0), most = least;
    for (int i = lanes; i < framelet_samples; i += lanes) {
        Lanes const off = residuals(values, fitted.plane, i);
        least = off < least ? off : least;
        most = off > most ? off : most;
    }
    Range const range{least_of(least), greatest_of(most)};
    fitted.plane.centre += range.middle();
    fitted.half_width = range.half_width();
    return fitted;
}

int find_members(GridFloats const& values, GridFloats const& weights, GridPlane const& plane, float tolerance,
                 GridFloats& members) {
    Lanes const one = Lanes{} + 1;
    Lanes counts{};
    for (int i = 0; i < framelet_samples; i += lanes) {
        Lanes const off = residuals(values, plane, i);
        auto const near = (off <= tolerance) & (off >= -tolerance) & (lanes_at(weights, i) != 0);
        Lanes const member = near ? one : Lanes{};
        *reinterpret_cast<Lanes*>(members.value + i) = member;
        counts += member;
    }
    return static_cast<int>(sum(counts));
}

} // namespace framelet
