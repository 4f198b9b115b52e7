#include "server/sampling/field/tiling.h"

#include "common/error.h"

namespace framelet {
namespace {

std::size_t tiles_across(ImagePlane const& plane, int depth, int pixels) {
    int const side = plane.tile_side(make_tile(depth, 0, 0));
    return static_cast<std::size_t>((pixels + side - 1) / side);
}

void add_visible(ImagePlane const& plane, Tile tile, int depth, std::vector<Tile>& out) {
    if (!plane.is_visible(tile)) {
        return;
    }
    if (tile.depth() == depth) {
        out.push_back(tile);
        return;
    }
    for (std::uint32_t quadrant = 0; quadrant < 4; ++quadrant) {
        add_visible(plane, tile.child(quadrant), depth, out);
    }
}

} // namespace

Tiling make_uniform_tiling(ImagePlane const& plane, int depth) {
    FRAMELET_CHECK(depth >= plane.min_depth() && depth <= plane.max_depth());
    Tiling tiling{plane, {}};
    tiling.tiles.reserve(uniform_tile_count(plane, depth));
    add_visible(plane, Tile{1}, depth, tiling.tiles);
    return tiling;
}

std::size_t uniform_tile_count(ImagePlane const& plane, int depth) {
    Viewport const viewport = plane.viewport();
    return tiles_across(plane, depth, viewport.width) * tiles_across(plane, depth, viewport.height);
}

} // namespace framelet
