#include "client/core/drawn_over/holes.h"

#include <algorithm>

#include "client/core/drawn_over/age_colors.h"
#include "common/error.h"

namespace framelet {

namespace {

void mark(std::uint8_t* pixel) {
    wash(pixel, hole_color, 1);
}

/// True where a framelet is held that covers this one of the finest tiles.
bool is_covered(FrameletCache const& cache, int column, int row) {
    int const finest = cache.plane().max_depth();
    for (int depth = finest; depth >= cache.plane().min_depth(); --depth) {
        if (cache.find(depth, column >> (finest - depth), row >> (finest - depth)) != nullptr) {
            return true;
        }
    }
    return false;
}

} // namespace

void draw_holes(std::span<PixelConfidence const> confidence, Picture& picture) {
    FRAMELET_CHECK(4 * confidence.size() == picture.rgba.size());
    for (std::size_t i = 0; i < confidence.size(); ++i) {
        if (confidence[i].seconds == PixelConfidence::made_up) {
            mark(picture.rgba.data() + 4 * i);
        }
    }
}

void draw_holes(FrameletCache const& cache, Picture& picture) {
    ImagePlane const& plane = cache.plane();
    FRAMELET_CHECK(picture.width == plane.viewport().width && picture.height == plane.viewport().height);
    int const side = plane.tile_side(make_tile(plane.max_depth(), 0, 0));
    for (int row = 0; row * side < picture.height; ++row) {
        for (int column = 0; column * side < picture.width; ++column) {
            if (is_covered(cache, column, row)) {
                continue;
            }
            for (int y = row * side; y < std::min((row + 1) * side, picture.height); ++y) {
                for (int x = column * side; x < std::min((column + 1) * side, picture.width); ++x) {
                    mark(picture.row(y) + 4 * static_cast<std::ptrdiff_t>(x));
                }
            }
        }
    }
}

} // namespace framelet
