// What a viewer holds of its picture, as both sides know it: later framelets are predicted from it. In: the framelets
// of each batch as they are decoded. Out: what a framelet would be if the picture had moved by a vector. PROTOCOL.md
// has the rules; both sides' pictures are the same bytes after the same batches.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>

#include "common/framelet/framelet.h"
#include "protocol/codec/color/point_grids.h"
#include "protocol/codec/color/search_picture.h"

namespace framelet {

/// Half pixels.
struct MotionVector {
    std::int8_t x = 0, y = 0;
    bool operator==(MotionVector const&) const = default;
};

/// Four values a pixel and plane: at half the spacing of the pixels coarse and fine framelets alike find what they
/// were. Nothing coarse is spread over the values that it stands for (`point_grids.h`). 16 bytes a pixel of the
/// viewport, rounded up to tiles of the coarsest kind, 15.8 MB at 1280x720; 4.2 more where it is kept for searches.
class ReferencePicture {
public:
    /// Larger viewports have no such picture: their framelets are coded without.
    static constexpr std::int64_t most_pixels = std::int64_t{1} << 23;
    static constexpr bool holds(Viewport viewport) {
        return std::int64_t{viewport.width} * viewport.height <= most_pixels;
    }

    /// What one takes that is kept for searches; of a viewport that it `holds`.
    static std::size_t bytes(Viewport viewport);

    /// Grey everywhere, unless it is that viewport's already. The viewport is one that it `holds`. Until then there is
    /// no picture, and no memory.
    void show(Viewport viewport);
    bool shows(Viewport viewport) const { return points_.width() != 0 && viewport == plane_.viewport(); }
    /// The framelets of one batch of the viewport that it shows; where they overlap the finer ones count.
    void take(std::span<DisplayFramelet const> framelets);

    /// Samples of `out` as the picture has them `vector` away from its tile, or as far as the picture reaches.
    void predict(Tile tile, MotionVector vector, DisplayFramelet& out) const;

    /// Says that a prediction from near the tile will be asked for soon.
    void expect(Tile tile) const;

    /// Where a tile lies, or what is moved from there: half pixels.
    struct Square {
        int left, top, side;
        /// Half pixels from sample to sample, logarithm to base 2; -1: two samples a half pixel.
        int pitch() const {
            return static_cast<int>(std::bit_width(static_cast<unsigned>(side / (framelet_side / 2)))) - 2;
        }
    };
    Square square(Tile tile) const;
    /// Moved, as far as the picture reaches.
    Square moved(Square const& square, MotionVector vector) const {
        return {std::clamp(square.left + vector.x, 0, points_.width() - square.side),
                std::clamp(square.top + vector.y, 0, points_.height() - square.side), square.side};
    }
    /// For whoever is about to look for vectors of these framelets. From the first call on more is kept, until another
    /// viewport is shown.
    void prepare_search(std::span<DisplayFramelet const> framelets);
    bool is_searched() const { return search_.is_kept(); }
    SearchPicture::Source searched(Square const& square, MotionVector vector) const {
        Square const from = moved(square, vector);
        return search_.source(from.left, from.top, from.side);
    }

    /// Whether predictions from them are the same.
    bool operator==(ReferencePicture const& other) const { return plane_ == other.plane_ && points_ == other.points_; }

private:
    void write(DisplayFramelet const& framelet);

    ImagePlane plane_;
    PointGrids points_; ///< red, green, blue; half pixels
    SearchPicture search_; ///< the same of green, if it is kept
};

} // namespace framelet
