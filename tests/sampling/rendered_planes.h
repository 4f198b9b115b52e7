// Framelets of planes that face the camera, as the renderer would give them: known depths, known colours.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "common/framelet/framelet.h"
#include "common/morton.h"
#include "server/sampling/mirror/mirror.h"
#include "server/stream/layers/layer_fit.h"

namespace framelet {

/// The surface that is seen at a pixel.
struct Seen {
    float depth = 10; ///< metres
    float luma = 0.5f; ///< display-encoded, [0, 1]
    BodyNumber body = static_body;
    float light = 0; ///< as of `Framelet::light`
};
using Look = std::function<Seen(float x, float y)>;

struct RenderedTile {
    Framelet rendered;
    DisplayFramelet shown;
    FrameletShape shape;
};

inline RenderedTile render_tile(ImagePlane const& plane, Tile tile, Look const& look) {
    RenderedTile out;
    out.rendered.tile = out.shown.tile = tile;
    out.rendered.red.fill(0);
    out.rendered.green.fill(0);
    out.rendered.blue.fill(0);
    out.rendered.body.resize(framelet_samples);
    out.rendered.light.resize(framelet_samples);
    PixelRect const rect = plane.tile_rect(tile);
    float const spacing = plane.sample_spacing(tile);
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        Seen const seen = look(static_cast<float>(rect.left) + (static_cast<float>(morton_x(i)) + 0.5f) * spacing,
                               static_cast<float>(rect.top) + (static_cast<float>(morton_y(i)) + 0.5f) * spacing);
        out.rendered.depth[i] = seen.depth;
        out.rendered.body[i] = seen.body;
        out.rendered.light[i] = seen.light;
        out.shown.red[i] = out.shown.green[i] = out.shown.blue[i] =
            static_cast<std::uint8_t>(std::lround(255 * seen.luma));
    }
    fit_layers(out.rendered, plane, {1e-5f}, out.shape);
    return out;
}

inline void cut_pieces(RenderedTile const& tile, ImagePlane const& plane, SceneTime time, std::vector<Piece>& pieces,
                       std::uint64_t batch = 1) {
    cut_pieces(tile.rendered, tile.shown, tile.shape, plane, time, batch, pieces);
}

/// Renders the pieces of all visible tiles of a depth.
inline std::vector<Piece> render_pieces(ImagePlane const& plane, int depth, Look const& look, SceneTime time = 0,
                                        std::uint64_t batch = 1) {
    std::vector<Piece> pieces;
    std::uint32_t const side = 1u << depth;
    for (std::uint32_t row = 0; row < side; ++row) {
        for (std::uint32_t column = 0; column < side; ++column) {
            Tile const tile = make_tile(depth, column, row);
            if (plane.is_visible(tile)) {
                RenderedTile const one = render_tile(plane, tile, look);
                cut_pieces(one, plane, time, pieces, batch);
            }
        }
    }
    return pieces;
}

/// Share of the picture's pixels that nothing covers, and the mean worn spacing of its cells.
struct Summary {
    double holes = 0;
    double worn = 0;
};
inline Summary summary_of(Mirror const& mirror) {
    Summary out;
    double pixels = 0, shown = 0;
    for (int row = 0; row < mirror.rows(); ++row) {
        for (int column = 0; column < mirror.columns(); ++column) {
            Cell const& cell = mirror.cell(column, row);
            pixels += mirror.pixels_of(column, row);
            out.holes += mirror.pixels_of(column, row) * (1 - static_cast<double>(cell.covered_share()));
            out.worn += cell.is_shown() ? static_cast<double>(cell.worn) : 0;
            shown += cell.is_shown() ? 1 : 0;
        }
    }
    return {out.holes / pixels, shown > 0 ? out.worn / shown : 0};
}

} // namespace framelet
