// Framelets with known content, for tests of what holds and shows them.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "common/color.h"
#include "common/framelet/framelet.h"

namespace framelet {

/// sRGB bytes of a place in the picture, pixel coordinates.
using Shade = std::function<std::array<std::uint8_t, 3>(float x, float y)>;

inline DisplayFramelet shade_framelet(ImagePlane const& plane, Tile tile, Shade const& shade) {
    DisplayFramelet out;
    out.tile = tile;
    PixelRect const rect = plane.tile_rect(tile);
    float const spacing = plane.sample_spacing(tile);
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        auto const color = shade(static_cast<float>(rect.left) + (static_cast<float>(morton_x(i)) + 0.5f) * spacing,
                                 static_cast<float>(rect.top) + (static_cast<float>(morton_y(i)) + 0.5f) * spacing);
        out.red[i] = color[0];
        out.green[i] = color[1];
        out.blue[i] = color[2];
    }
    return out;
}

inline DisplayFramelet constant_framelet(ImagePlane const& plane, Tile tile, std::uint8_t value) {
    return shade_framelet(plane, tile, [value](float, float) { return std::array{value, value, value}; });
}

inline Batch make_batch(ImagePlane const& plane, std::uint64_t number, std::vector<DisplayFramelet> framelets) {
    Batch out;
    out.number = number;
    out.view.number = 1;
    out.view.held_since = 1;
    out.view.viewport = plane.viewport();
    out.framelets = std::move(framelets);
    return out;
}

/// Every visible tile of one depth.
inline std::vector<Tile> visible_tiles(ImagePlane const& plane, int depth) {
    std::vector<Tile> out;
    for (std::uint32_t row = 0; row < 1u << depth; ++row) {
        for (std::uint32_t column = 0; column < 1u << depth; ++column) {
            if (plane.is_visible(make_tile(depth, column, row))) {
                out.push_back(make_tile(depth, column, row));
            }
        }
    }
    return out;
}

inline std::vector<DisplayFramelet> shade_tiles(ImagePlane const& plane, std::vector<Tile> const& tiles,
                                                Shade const& shade) {
    std::vector<DisplayFramelet> out;
    for (Tile const tile : tiles) {
        out.push_back(shade_framelet(plane, tile, shade));
    }
    return out;
}

/// A visible tile of any allowed depth.
inline Tile random_tile(ImagePlane const& plane, std::mt19937& random) {
    int const depth = std::uniform_int_distribution(plane.min_depth(), plane.max_depth())(random);
    int const side = plane.tile_side(make_tile(depth, 0, 0));
    auto const below = [&](int pixels) {
        return static_cast<std::uint32_t>(std::uniform_int_distribution(0, (pixels - 1) / side)(random));
    };
    std::uint32_t const column = below(plane.viewport().width);
    return make_tile(depth, column, below(plane.viewport().height));
}

inline DisplayFramelet random_framelet(ImagePlane const& plane, std::mt19937& random) {
    DisplayFramelet out;
    out.tile = random_tile(plane, random);
    for (auto* const samples : {&out.red, &out.green, &out.blue}) {
        std::generate(samples->begin(), samples->end(), [&] { return static_cast<std::uint8_t>(random()); });
    }
    return out;
}

} // namespace framelet
