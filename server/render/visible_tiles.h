// The tiles of one depth that show in a picture.
#pragma once

#include <vector>

#include "common/framelet/tile.h"

namespace framelet {

/// In the order of their codes.
inline std::vector<Tile> visible_tiles(ImagePlane const& plane, int depth) {
    std::vector<Tile> tiles;
    for (std::uint32_t code = 1u << (2 * depth); code < 2u << (2 * depth); ++code) {
        if (plane.is_visible({code})) {
            tiles.push_back({code});
        }
    }
    return tiles;
}

} // namespace framelet
