#include "client/core/drawn_over/framelet_outlines.h"

#include <algorithm>
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

float opacity_of(PixelRect const& tile) {
    return tile.width() <= small_side ? 0.35f : 0.8f;
}

/// Draws a tile's left and upper edges: the others are those of neighbours.
void draw_edges(Picture& picture, PixelRect const& rect, OverlayColor const& color) {
    float const opacity = opacity_of(rect);
    blend(picture, {rect.left, rect.top, rect.right, rect.top + 1}, color, opacity);
    blend(picture, {rect.left, rect.top + 1, rect.left + 1, rect.bottom}, color, opacity);
}

/// Calls `visit` with each framelet that is held.
template <class Visit>
void for_each_held(FrameletPool const& pool, Visit visit) {
    for (std::size_t i = 0; i < pool.slot_count(); ++i) {
        FrameletCache const& cache = pool.slot(i);
        for (std::size_t slot = 0; slot < cache.slot_count(); ++slot) {
            if (CachedFramelet const* const framelet = cache.at_slot(slot)) {
                visit(*framelet);
            }
        }
    }
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

void draw_arrivals(FrameletPool const& pool, Picture& picture) {
    ImagePlane const& plane = pool.plane();
    FRAMELET_CHECK(picture.width == plane.viewport().width && picture.height == plane.viewport().height);
    std::uint64_t newest = 0;
    for_each_held(pool, [&](CachedFramelet const& framelet) { newest = std::max(newest, framelet.moment.batch); });
    for_each_held(pool, [&](CachedFramelet const& framelet) {
        if (framelet.moment.batch != newest) {
            return;
        }
        OverlayColor const color = color_of(0);
        PixelRect const rect = plane.tile_rect(framelet.tile);
        draw_edges(picture, rect, color);
        // Its neighbours may be of other batches, and have no edges then.
        blend(picture, {rect.left + 1, rect.bottom - 1, rect.right, rect.bottom}, color, opacity_of(rect));
        blend(picture, {rect.right - 1, rect.top + 1, rect.right, rect.bottom - 1}, color, opacity_of(rect));
    });
}

} // namespace framelet
