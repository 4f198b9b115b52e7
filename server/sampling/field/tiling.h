// Tilings: disjoint tiles that cover the viewport. In: an image plane and a depth. Out: a list of tiles.
#pragma once

#include <cstddef>
#include <vector>

#include "common/framelet/tile.h"

namespace framelet {

/// Disjoint tiles that together cover every pixel of the viewport, along the Morton curve; none lies wholly outside.
struct Tiling {
    ImagePlane plane;
    std::vector<Tile> tiles;

    bool operator==(Tiling const&) const = default;
};

/// Every visible tile of one depth (uniform spatial density).
Tiling make_uniform_tiling(ImagePlane const& plane, int depth);

/// Number of tiles of that tiling, found without making it.
std::size_t uniform_tile_count(ImagePlane const& plane, int depth);

} // namespace framelet
