// Tiles: nodes of a quadtree over a square image plane ([Stephens 2011] section 4.1), named by a Morton code with a
// leading 1.
#pragma once

#include <bit>
#include <compare>
#include <cstdint>

#include "common/camera.h"
#include "common/morton.h"

namespace framelet {

/// Samples along one side of a framelet, and in a whole one.
inline constexpr int framelet_side = 16;
inline constexpr int framelet_samples = framelet_side * framelet_side;

/// The number of quadtree levels by which a tile may be coarser or finer than one sample a pixel (a level is a factor
/// of 4).
inline constexpr int coarsest_levels = 3;
inline constexpr int finest_levels = 2;

/// A quadtree node. The root is code 1, the children of m are 4m .. 4m+3. Code 0 names no tile.
struct Tile {
    std::uint32_t code = 1;

    auto operator<=>(Tile const&) const = default;

    constexpr int depth() const { return static_cast<int>(std::bit_width(code) - 1) / 2; }
    constexpr Tile parent() const { return {code >> 2}; }
    constexpr Tile child(std::uint32_t quadrant) const { return {code * 4 + quadrant}; }
    /// Column and row among the 2^depth x 2^depth tiles of the same depth.
    constexpr std::uint32_t column() const { return morton_x(index()); }
    constexpr std::uint32_t row() const { return morton_y(index()); }
    /// Position along the Morton curve of its depth.
    constexpr std::uint32_t index() const { return code - (1u << (2 * depth())); }
};

/// Names one framelet of a session: no batch has two of a tile.
struct SentTile {
    std::uint64_t batch = 0;
    Tile tile;

    auto operator<=>(SentTile const&) const = default;
};

/// True when the code's leading 1 stands where a quadtree puts it (an even bit).
constexpr bool is_tile_code(std::uint32_t code) {
    return code != 0 && std::bit_width(code) % 2 == 1;
}

constexpr Tile make_tile(int depth, std::uint32_t column, std::uint32_t row) {
    return {(1u << (2 * depth)) + morton_index(column, row)};
}

/// Rectangle in pixels; `right` and `bottom` are exclusive.
struct PixelRect {
    int left = 0, top = 0, right = 0, bottom = 0;

    bool operator==(PixelRect const&) const = default;
    bool empty() const { return left >= right || top >= bottom; }
    int width() const { return right - left; }
    int height() const { return bottom - top; }
};

/// The square of side 16 * 2^k pixels, the smallest that covers the viewport, whose corner the viewport is.
/// Depth k has one sample per pixel.
class ImagePlane {
public:
    ImagePlane() : ImagePlane(Viewport{}) {}
    explicit ImagePlane(Viewport viewport);

    bool operator==(ImagePlane const&) const = default;

    Viewport viewport() const { return viewport_; }
    int pixel_depth() const { return pixel_depth_; }
    int min_depth() const { return pixel_depth_ > coarsest_levels ? pixel_depth_ - coarsest_levels : 0; }
    int max_depth() const { return pixel_depth_ + finest_levels; }
    int side() const { return framelet_side << pixel_depth_; }

    /// Side of a tile in pixels (may be 4 for the finest).
    int tile_side(Tile tile) const { return side() >> tile.depth(); }
    /// Distance between neighbouring samples, pixels: 8 for the coarsest tiles, 1/4 for the finest.
    float sample_spacing(Tile tile) const {
        return static_cast<float>(tile_side(tile)) / static_cast<float>(framelet_side);
    }
    /// The tile's area, not clipped to the viewport.
    PixelRect tile_rect(Tile tile) const;
    /// True when some pixel of the tile is in the viewport.
    bool is_visible(Tile tile) const;
    /// True when a framelet may be rendered for this tile: known code, depth within limits, in the viewport.
    bool accepts(Tile tile) const;

private:
    Viewport viewport_;
    int pixel_depth_;
};

} // namespace framelet
