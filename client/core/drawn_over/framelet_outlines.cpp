#include "client/core/drawn_over/framelet_outlines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "client/core/drawn_over/age_colors.h"
#include "common/error.h"

namespace framelet {

namespace {

/// Age in batches from which on outlines are darkest.
constexpr float oldest = 1024;
/// Side of a tile, pixels, up to which its outline is faint: it would hide the picture.
constexpr int small_side = 8;

OverlayColor color_of(std::uint64_t age) {
    return age_color(std::log2(1 + static_cast<float>(age)) / std::log2(1 + oldest));
}

void blend(Picture& picture, PixelRect const& rect, OverlayColor const& color, float opacity) {
    for (int y = rect.top; y < std::min(rect.bottom, picture.height); ++y) {
        for (int x = rect.left; x < std::min(rect.right, picture.width); ++x) {
            std::uint8_t* const pixel = picture.row(y) + 4 * static_cast<std::ptrdiff_t>(x);
            for (std::size_t i = 0; i < color.size(); ++i) {
                float const mixed = static_cast<float>(pixel[i]) * (1 - opacity) + color[i] * opacity;
                pixel[i] = static_cast<std::uint8_t>(std::lround(mixed));
            }
        }
    }
}

/// Draws a tile's left and upper edges: the others are those of neighbours.
void draw_edges(Picture& picture, PixelRect const& rect, OverlayColor const& color) {
    float const opacity = rect.width() <= small_side ? 0.35f : 0.8f;
    blend(picture, {rect.left, rect.top, rect.right, rect.top + 1}, color, opacity);
    blend(picture, {rect.left, rect.top + 1, rect.left + 1, rect.bottom}, color, opacity);
}

} // namespace

void draw_outlines(FrameletCache const& cache, Picture& picture) {
    ImagePlane const& plane = cache.plane();
    FRAMELET_CHECK(picture.width == plane.viewport().width && picture.height == plane.viewport().height);
    std::vector<CachedFramelet const*> held;
    for (int depth = plane.min_depth(); depth <= plane.max_depth(); ++depth) {
        int const side = plane.tile_side(make_tile(depth, 0, 0));
        for (int row = 0; row * side < picture.height; ++row) {
            for (int column = 0; column * side < picture.width; ++column) {
                if (CachedFramelet const* const framelet = cache.find(depth, column, row)) {
                    held.push_back(framelet);
                }
            }
        }
    }
    // Framelets are drawn after those that they cover: newer ones, and finer ones of the same batch.
    std::ranges::sort(held, [](CachedFramelet const* a, CachedFramelet const* b) {
        return a->moment.batch != b->moment.batch ? a->moment.batch < b->moment.batch : a->tile < b->tile;
    });
    for (CachedFramelet const* const framelet : held) {
        draw_edges(picture, plane.tile_rect(framelet->tile),
                   color_of(held.back()->moment.batch - framelet->moment.batch));
    }
}

} // namespace framelet
