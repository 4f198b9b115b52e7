#include "common/fine_merge.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace framelet {

namespace {

/// Children along a side of what is merged.
constexpr int most_children = 8;

/// Samples copied at a time; the side of a child is a multiple of it.
constexpr int run = framelet_side >> finest_levels;

using Children = std::array<CachedFramelet const*, static_cast<std::size_t>(most_children* most_children)>;

bool belong_together(CachedFramelet const& a, CachedFramelet const& b) {
    Layer const& la = a.shape.layers[0].layer;
    Layer const& lb = b.shape.layers[0].layer;
    return a.view == b.view && b.shape.layer_count == 1 && b.shape.loose.empty() && la.body == lb.body &&
           la.velocity == lb.velocity;
}

double value_at(Layer const& layer, double x, double y) {
    return layer.at + layer.dx * x + layer.dy * y;
}

/// To the inverse depths in the middles of n x n children of `side` pixels, from the first one's corner.
Layer fit(Children const& children, int n, int side) {
    double const middle = 0.5 * (n - 1);
    double mean = 0, dx = 0, dy = 0, squares = 0;
    float error = 0;
    for (int i = 0; i < n * n; ++i) {
        Layer const& layer = children[static_cast<std::size_t>(i)]->shape.layers[0].layer;
        double const value = value_at(layer, 0.5 * side, 0.5 * side);
        double const x = i % n - middle;
        mean += value / (n * n);
        dx += value * x;
        dy += value * (i / n - middle);
        squares += x * x;
        error = std::max(error, layer.error);
    }
    dx /= squares * side;
    dy /= squares * side;
    Layer out = children[0]->shape.layers[0].layer;
    out.at = static_cast<float>(mean - (dx + dy) * 0.5 * n * side);
    out.dx = static_cast<float>(dx);
    out.dy = static_cast<float>(dy);
    out.error = error;
    return out;
}

/// Largest difference of the plane from the children's layers at the corners of their tiles.
double largest_difference(Layer const& plane, Children const& children, int n, int side) {
    double largest = 0;
    for (int i = 0; i < n * n; ++i) {
        Layer const& layer = children[static_cast<std::size_t>(i)]->shape.layers[0].layer;
        for (int corner = 0; corner < 4; ++corner) {
            int const x = corner % 2 * side;
            int const y = corner / 2 * side;
            largest = std::max(largest,
                               std::abs(value_at(layer, x, y) - value_at(plane, i % n * side + x, i / n * side + y)));
        }
    }
    return largest;
}

} // namespace

bool merge_fine(FrameletCache const& cache, Tile over, int depth, double tolerance, MergedFramelet& merged) {
    int const n = 1 << (depth - over.depth());
    Children children{};
    for (int i = 0; i < n * n; ++i) {
        CachedFramelet const* const child =
            cache.find(depth, n * static_cast<int>(over.column()) + i % n, n * static_cast<int>(over.row()) + i / n);
        children[static_cast<std::size_t>(i)] = child;
        if (child == nullptr || !belong_together(*children[0], *child)) {
            return false;
        }
    }
    int const pixels = cache.plane().tile_side(children[0]->tile);
    Layer const plane = fit(children, n, pixels);
    double const difference = largest_difference(plane, children, n, pixels);
    if (!(difference <= tolerance)) {
        return false;
    }
    int const side = children[0]->shape.side;
    merged.tile = over;
    merged.first = children[0];
    merged.side = n * side;
    merged.grid.resize(static_cast<std::size_t>(merged.side * merged.side));
    auto const last = static_cast<std::int8_t>(merged.side - 1);
    merged.layer = {plane, 0, 0, last, last};
    merged.layer.layer.error += static_cast<float>(difference);
    merged.newest_batch = 0;
    merged.signature = 0;
    for (int i = 0; i < n * n; ++i) {
        CachedFramelet const& child = *children[static_cast<std::size_t>(i)];
        merged.newest_batch = std::max(merged.newest_batch, child.moment.batch);
        merged.signature = (merged.signature + child.moment.batch) * 0x9e3779b97f4a7c15u;
        PackedSample const* const grid = side == framelet_side ? child.samples.data() : child.shape.reduced.data();
        for (int y = 0; y < side; ++y) {
            PackedSample const* const from = grid + y * side;
            PackedSample* const to =
                &merged.grid[static_cast<std::size_t>((i / n * side + y) * merged.side + i % n * side)];
            for (int x = 0; x < side; x += run) {
                std::memcpy(to + x, from + x, run * sizeof(PackedSample));
            }
        }
    }
    return true;
}

} // namespace framelet
