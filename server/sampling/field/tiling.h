// Tilings: disjoint tiles that cover the viewport. In: an image plane and a density; out: a list of tiles.
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

/// How many tiles that has; costs nothing.
std::size_t uniform_tile_count(ImagePlane const& plane, int depth);

} // namespace framelet
