// Sample density over the image plane ([Stephens 2011] section 3.1.1): two scalar fields over equal elements, the tiles
// of one depth, in Morton order. In and out: fields of other resolution, and values of the tiles of a tiling.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/framelet/tile.h"
#include "tests/evaluation/methods/response/density.h"

namespace framelet {

/// 4^depth elements. Double, because what is moved between elements in 10^5 cycles must add up.
struct DensityField {
    int depth = 0;
    std::vector<double> space; ///< samples per pixel
    std::vector<double> time; ///< refreshes per second

    bool operator==(DensityField const&) const = default;
    std::size_t size() const { return space.size(); }
};

DensityField make_uniform_density(int depth, Density density);

/// Sum of samples per pixel and second over the elements: conserved by the response ([Stephens 2011] eq. 6.24).
double combined_density(DensityField const& field);

/// The field of 4^k values at 4^depth elements: the mean of what a coarser element covers, a copy for each of the finer
/// ones. Either way the integral over the plane stays ([Stephens 2011] section 4.1.3.4).
std::vector<double> resample_field(std::span<double const> field, int depth);

/// Mean of the field (4^k values) over each tile; a tile within one element has that element's value.
void tiles_from_field(std::span<Tile const> tiles, std::span<double const> field, std::span<double> values);

/// Writes each tile's value to the elements that it covers; where several tiles lie in one element, their mean by area.
/// Elements that no tile touches keep their value. Tiles must be disjoint and in depth-first order (as those of a
/// tiling are; otherwise see depth_first_order.h), so that an element's tiles lie side by side.
void field_from_tiles(std::span<Tile const> tiles, std::span<double const> values, std::span<double> field);

} // namespace framelet
