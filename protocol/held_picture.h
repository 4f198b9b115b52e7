// What a viewer holds of its picture, as both sides know it: later framelets are predicted from it. In: the framelets
// of each batch as they are decoded. Out: what a framelet would be if the picture had moved by a vector. PROTOCOL.md
// has the rules; both sides' pictures are the same bytes after the same batches.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/framelet.h"

namespace framelet {

inline constexpr std::size_t cache_line = 64;

/// Half pixels.
struct PictureVector {
    std::int8_t x = 0, y = 0;
    bool operator==(PictureVector const&) const = default;
};

/// Four values a pixel and plane: at half the spacing of the pixels coarse and fine framelets alike find what they
/// were. 12 bytes a pixel of the viewport, rounded up to tiles of the coarsest kind: 11.8 MB at 1280x720.
class HeldPicture {
public:
    /// Larger viewports have no such picture: their framelets are coded without.
    static constexpr std::int64_t most_pixels = std::int64_t{1} << 23;
    static constexpr bool holds(Viewport viewport) {
        return std::int64_t{viewport.width} * viewport.height <= most_pixels;
    }

    /// Grey everywhere, unless it is that viewport's already. The viewport is one that it `holds`. Until then there is
    /// no picture, and no memory.
    void show(Viewport viewport);
    bool shows(Viewport viewport) const { return width_ != 0 && viewport == plane_.viewport(); }
    /// The framelets of one batch of the viewport that it shows; where they overlap the finer ones count.
    void take(std::span<DisplayFramelet const> framelets);

    /// Samples of `out` as the picture has them `vector` away from its tile, or as far as the picture reaches.
    void predict(Tile tile, PictureVector vector, DisplayFramelet& out) const;

    /// Says that a prediction from near the tile's place will be asked for soon.
    void expect(Tile tile) const;

    /// Where a tile lies: half pixels.
    struct Place {
        int left, top, side;
    };
    Place place(Tile tile) const;

    /// Where the prediction of what lies there comes from: half pixels, of one plane.
    struct Source {
        std::uint8_t const* first; ///< upper left value of the tile moved
        std::size_t stride; ///< from one row to the next
        int pitch; ///< half pixels from sample to sample; 0: two samples a half pixel
    };
    Source source(Place const& place, PictureVector vector, std::size_t plane) const {
        int const left = std::clamp(place.left + vector.x, 0, width_ - place.side);
        int const top = std::clamp(place.top + vector.y, 0, height_ - place.side);
        return {values(plane) + at(left, top), static_cast<std::size_t>(width_), place.side / framelet_side};
    }

    bool operator==(HeldPicture const&) const = default;

private:
    /// Rows of coarse tiles are whole lines of the cache where they are written.
    struct alignas(cache_line) Line {
        std::array<std::uint8_t, cache_line> values;
        bool operator==(Line const&) const = default;
    };

    std::size_t at(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }
    std::uint8_t const* values(std::size_t plane) const {
        return reinterpret_cast<std::uint8_t const*>(values_[plane].data());
    }
    void write(DisplayFramelet const& framelet);

    ImagePlane plane_;
    int width_ = 0, height_ = 0; ///< half pixels
    std::array<std::vector<Line>, 3> values_; ///< red, green, blue, rows from the top
};

} // namespace framelet
