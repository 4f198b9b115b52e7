// Patches: equal tiles side by side, of which work is planned.
#pragma once

#include <cstdint>
#include <vector>

#include "common/framelet/tile.h"

namespace framelet {

/// The tiles of one depth in one quadtree node.
struct Patch {
    Tile node;
    int depth = 0; ///< depth of its tiles, >= node.depth()

    bool operator==(Patch const&) const = default;
};

/// Number of tiles of a patch, including those outside the viewport.
constexpr double tile_count(Patch const& patch) {
    return static_cast<double>(std::uint64_t{1} << (2 * (patch.depth - patch.node.depth())));
}

/// Appends the patch's visible tiles, along the Morton curve.
void append_tiles(ImagePlane const& plane, Patch const& patch, std::vector<Tile>& tiles);

} // namespace framelet
