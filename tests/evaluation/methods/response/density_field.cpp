#include "tests/evaluation/methods/response/density_field.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "common/error.h"

namespace framelet {
namespace {

std::size_t element_count(int depth) {
    FRAMELET_CHECK(depth >= 0 && depth < 16);
    return std::size_t(1) << (2 * depth);
}

int field_depth(std::size_t count) {
    FRAMELET_CHECK(std::has_single_bit(count) && std::countr_zero(count) % 2 == 0);
    return std::countr_zero(count) / 2;
}

double mean(std::span<double const> values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Interval of the elements under a tile: all that lie in it, or the one that it lies in.
struct Interval {
    std::size_t first, count;
};

Interval covered(Tile tile, int depth) {
    int const levels = depth - tile.depth();
    return levels >= 0 ? Interval{std::size_t(tile.index()) << (2 * levels), std::size_t(1) << (2 * levels)}
                       : Interval{std::size_t(tile.index()) >> (-2 * levels), 1};
}

} // namespace

DensityField make_uniform_density(int depth, Density density) {
    std::size_t const count = element_count(depth);
    return {depth, std::vector<double>(count, density.space), std::vector<double>(count, density.time)};
}

double combined_density(DensityField const& field) {
    return std::inner_product(field.space.begin(), field.space.end(), field.time.begin(), 0.0);
}

std::vector<double> resample_field(std::span<double const> field, int depth) {
    int const from = field_depth(field.size());
    std::vector<double> out(element_count(depth));
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = depth >= from ? field[i >> (2 * (depth - from))]
                               : mean(field.subspan(i << (2 * (from - depth)), std::size_t(1) << (2 * (from - depth))));
    }
    return out;
}

void tiles_from_field(std::span<Tile const> tiles, std::span<double const> field, std::span<double> values) {
    FRAMELET_CHECK(values.size() == tiles.size());
    int const depth = field_depth(field.size());
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        auto const [first, count] = covered(tiles[i], depth);
        values[i] = mean(field.subspan(first, count));
    }
}

void field_from_tiles(std::span<Tile const> tiles, std::span<double const> values, std::span<double> field) {
    FRAMELET_CHECK(values.size() == tiles.size());
    int const depth = field_depth(field.size());
    for (std::size_t i = 0; i < tiles.size();) {
        auto const [first, count] = covered(tiles[i], depth);
        if (tiles[i].depth() <= depth) {
            std::fill_n(field.begin() + static_cast<std::ptrdiff_t>(first), count, values[i]);
            ++i;
            continue;
        }
        double sum = 0, weight = 0;
        for (; i < tiles.size() && tiles[i].depth() > depth && covered(tiles[i], depth).first == first; ++i) {
            double const share = 1 / static_cast<double>(std::size_t(1) << (2 * (tiles[i].depth() - depth)));
            sum += share * values[i];
            weight += share;
        }
        field[first] = sum / weight;
    }
}

} // namespace framelet
