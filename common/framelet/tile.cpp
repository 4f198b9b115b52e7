#include "common/framelet/tile.h"

#include <algorithm>

#include "common/error.h"

namespace framelet {

ImagePlane::ImagePlane(Viewport viewport) : viewport_(viewport), pixel_depth_(0) {
    FRAMELET_CHECK(viewport.width >= 1 && viewport.height >= 1);
    FRAMELET_CHECK(viewport.width <= max_viewport_side && viewport.height <= max_viewport_side);
    while (side() < std::max(viewport.width, viewport.height)) {
        ++pixel_depth_;
    }
}

PixelRect ImagePlane::tile_rect(Tile tile) const {
    int const size = tile_side(tile);
    int const left = static_cast<int>(tile.column()) * size;
    int const top = static_cast<int>(tile.row()) * size;
    return {left, top, left + size, top + size};
}

bool ImagePlane::is_visible(Tile tile) const {
    PixelRect const rect = tile_rect(tile);
    return rect.left < viewport_.width && rect.top < viewport_.height;
}

bool ImagePlane::accepts(Tile tile) const {
    return is_tile_code(tile.code) && tile.depth() >= min_depth() && tile.depth() <= max_depth() && is_visible(tile);
}

} // namespace framelet
