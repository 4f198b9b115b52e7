// Tilings of equal tiles, for tests and for methods that sample the whole picture evenly. In: an image plane and a
// depth. Out: a list of disjoint tiles that cover the viewport.
#pragma once

#include <cstddef>
#include <vector>

#include "common/error.h"
#include "common/framelet/tile.h"

namespace framelet {

/// Disjoint tiles that together cover every pixel of the viewport, along the Morton curve; none lies wholly outside.
struct Tiling {
    ImagePlane plane;
    std::vector<Tile> tiles;

    bool operator==(Tiling const&) const = default;
};

/// Number of the tiles of one depth that are visible.
inline std::size_t uniform_tile_count(ImagePlane const& plane, int depth) {
    auto const tiles_across = [&](int pixels) {
        int const side = plane.tile_side(make_tile(depth, 0, 0));
        return static_cast<std::size_t>((pixels + side - 1) / side);
    };
    return tiles_across(plane.viewport().width) * tiles_across(plane.viewport().height);
}

inline void add_visible_tiles(ImagePlane const& plane, Tile tile, int depth, std::vector<Tile>& out) {
    if (!plane.is_visible(tile)) {
        return;
    }
    if (tile.depth() == depth) {
        out.push_back(tile);
        return;
    }
    for (std::uint32_t quadrant = 0; quadrant < 4; ++quadrant) {
        add_visible_tiles(plane, tile.child(quadrant), depth, out);
    }
}

/// Every visible tile of one depth.
inline Tiling make_uniform_tiling(ImagePlane const& plane, int depth) {
    FRAMELET_CHECK(depth >= plane.min_depth() && depth <= plane.max_depth());
    Tiling tiling{plane, {}};
    tiling.tiles.reserve(uniform_tile_count(plane, depth));
    add_visible_tiles(plane, Tile{1}, depth, tiling.tiles);
    return tiling;
}

} // namespace framelet
