// The reference picture: what a viewer holds of its picture, as both sides know it, so that later framelets are
// predicted from it. In: the framelets of each batch as they are decoded. Out: what a framelet would be if the picture
// had moved by a vector. PROTOCOL.md has the rules; both sides' pictures are the same bytes after the same batches.
#pragma once

#include <algorithm>
#include <bit>
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "common/framelet/framelet.h"
#include "protocol/codec/color/point_grids.h"
#include "protocol/codec/color/search_picture.h"

namespace framelet {

/// Motion vector, half pixels: from a tile to where in the reference picture its framelet is predicted from.
struct MotionVector {
    std::int8_t x = 0, y = 0;
    bool operator==(MotionVector const&) const = default;
};

/// The picture has four values a pixel and plane: points half a pixel apart, at which coarse and fine framelets alike
/// find what they were. Nothing coarse is spread over the values that it stands for (`point_grids.h`). It takes 16
/// bytes a pixel of the viewport rounded up to tiles of the coarsest level, 15.8 MB at 1280x720, and 4.2 more where it
/// is kept for searches.
class ReferencePicture {
public:
    /// The largest number of pixels of a viewport that has a reference picture: framelets of larger ones are coded
    /// without.
    static constexpr std::int64_t most_pixels = std::int64_t{1} << 23;
    static constexpr bool holds(Viewport viewport) {
        return std::int64_t{viewport.width} * viewport.height <= most_pixels;
    }

    /// Bytes that a picture takes which is kept for searches, of a viewport that it `holds`.
    static std::size_t bytes(Viewport viewport);

    /// Sets the viewport, one that it `holds`: the picture becomes grey everywhere, unless it is that viewport's
    /// already. Until the first call there is no picture, and no memory.
    void show(Viewport viewport);
    bool shows(Viewport viewport) const { return points_.width() != 0 && viewport == plane_.viewport(); }
    /// Takes in the framelets of one batch of the viewport that it shows; where they overlap the finer ones count.
    void take(std::span<DisplayFramelet const> framelets);

    /// Fills the samples of `out` with what the picture has `vector` away from the tile, or as far away as the picture
    /// reaches.
    void predict(Tile tile, MotionVector vector, DisplayFramelet& out) const;

    /// Says that a prediction from near the tile will be asked for soon.
    void expect(Tile tile) const;

    /// The square of a tile in the picture, or one that is moved from there; half pixels.
    struct Square {
        int left, top, side;
        /// Logarithm to base 2 of the half pixels from sample to sample; -1: two samples a half pixel.
        int pitch() const {
            return static_cast<int>(std::bit_width(static_cast<unsigned>(side / (framelet_side / 2)))) - 2;
        }
    };
    Square square(Tile tile) const;
    /// The square moved by a vector, as far as the picture reaches.
    Square moved(Square const& square, MotionVector vector) const {
        return {std::clamp(square.left + vector.x, 0, points_.width() - square.side),
                std::clamp(square.top + vector.y, 0, points_.height() - square.side), square.side};
    }
    /// Must be called before vectors of these framelets are searched. From the first call on more is kept, until
    /// another viewport is shown.
    void prepare_search(std::span<DisplayFramelet const> framelets);
    bool is_searched() const { return search_.is_kept(); }
    SearchPicture::Source searched(Square const& square, MotionVector vector) const {
        Square const from = moved(square, vector);
        return search_.source(from.left, from.top, from.side);
    }

    /// True where predictions from both are the same.
    bool operator==(ReferencePicture const& other) const { return plane_ == other.plane_ && points_ == other.points_; }

private:
    void write(DisplayFramelet const& framelet);

    /// A framelet of a batch, in the order in which they are written: of each tile of the coarsest level the coarse
    /// ones first.
    struct Written {
        std::uint32_t coarsest = 0; ///< code of that tile
        int depth = 0;
        std::uint32_t index = 0;
        auto operator<=>(Written const&) const = default;
    };

    ImagePlane plane_;
    PointGrids points_; ///< red, green, blue; half pixels
    SearchPicture search_; ///< green once more, if it is kept for searches
    std::vector<Written> order_; ///< scratch
    std::vector<std::size_t> first_; ///< scratch: where tiles of the coarsest level begin in it, and its end
};

} // namespace framelet
