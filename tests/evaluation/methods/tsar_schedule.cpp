#include "tests/evaluation/methods/tsar_schedule.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace framelet::bench {
namespace {

/// Sums of the elements before each element, and of all.
std::vector<double> prefix_sums(std::span<double const> values) {
    std::vector<double> sums(values.size() + 1);
    std::inclusive_scan(values.begin(), values.end(), sums.begin() + 1);
    return sums;
}

} // namespace

Tiling make_density_tiling(ImagePlane const& plane, std::span<double const> samples_per_pixel, int field_depth,
                           double most_samples) {
    auto const sums = prefix_sums(samples_per_pixel);
    double const element_side = static_cast<double>(plane.side()) / static_cast<double>(1u << field_depth);
    auto const samples_in = [&](Tile tile) {
        int const levels = field_depth - tile.depth();
        if (levels < 0) { // the tile lies within one element
            std::size_t const element = tile.index() >> (-2 * levels);
            return (sums[element + 1] - sums[element]) * element_side * element_side / std::exp2(-2 * levels);
        }
        std::size_t const first = std::size_t(tile.index()) << (2 * levels);
        return (sums[first + (std::size_t(1) << (2 * levels))] - sums[first]) * element_side * element_side;
    };
    Tiling tiling{plane, {}};
    std::vector<Tile> open{Tile{1}};
    while (!open.empty()) {
        Tile const tile = open.back();
        open.pop_back();
        if (!plane.is_visible(tile)) {
            continue;
        }
        bool const fine_enough = tile.depth() >= plane.min_depth() && samples_in(tile) <= most_samples;
        if (fine_enough || tile.depth() == plane.max_depth()) {
            tiling.tiles.push_back(tile);
            continue;
        }
        for (std::uint32_t quadrant = 4; quadrant-- > 0;) {
            open.push_back(tile.child(quadrant));
        }
    }
    return tiling;
}

std::vector<std::size_t> select_overdue(std::span<Tile const> tiles, DensityField const& density,
                                        std::span<double const> refreshed, double now, std::size_t count) {
    std::vector<double> rates(tiles.size()), last(tiles.size()), overdue(tiles.size());
    tiles_from_field(tiles, density.time, rates);
    tiles_from_field(tiles, refreshed, last);
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        overdue[i] = (now - last[i]) * rates[i];
    }
    std::vector<std::size_t> chosen(tiles.size());
    std::iota(chosen.begin(), chosen.end(), std::size_t(0));
    if (count < chosen.size()) {
        // Of equals the first are taken, so that a run can be repeated.
        std::ranges::nth_element(
            chosen, chosen.begin() + static_cast<std::ptrdiff_t>(count),
            [&](std::size_t a, std::size_t b) { return overdue[a] != overdue[b] ? overdue[a] > overdue[b] : a < b; });
        chosen.resize(count);
        std::ranges::sort(chosen);
    }
    return chosen;
}

} // namespace framelet::bench
