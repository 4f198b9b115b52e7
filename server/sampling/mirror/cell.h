// Cells: squares of 4x4 pixels of the picture, by which the server knows what a viewer shows there. In: a box of the
// picture. Out: the cells, and the pixels in them, that it covers.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "common/math.h"

namespace framelet {

/// Side of a cell, pixels.
inline constexpr int cell_side = 4;
inline constexpr int cell_pixels = cell_side * cell_side;

/// What a cell of the picture shows.
struct Cell {
    float inverse_depth = -1; ///< of the surface that shows, in the middle of the cell, 1 / metres; -1: none
    float worn = 0; ///< worn spacing of the piece that shows, pixels; 0 where nothing shows
    float detail = 0; ///< of the piece that shows (`Piece::detail`), in this picture's pixels
    float spacing = 0; ///< of the samples of the piece that shows, as they were rendered, pixels
    float decorrelation = 0; ///< of the piece that shows, pixels of spacing a second
    std::uint32_t piece = 0; ///< index of that piece among those of its moment
    std::uint16_t covered = 0; ///< by anything: a bit for each pixel, row by row
    std::uint8_t moment = 0; ///< slot of the moment of that piece
    std::uint8_t share = 0; ///< number of its 16 pixels that the piece that shows covers
    bool leads = false; ///< what shows is a shadow that shows before better samples, as with the viewer
    bool is_lost = false; ///< what shows has drifted for longer than is known where to
    bool is_outdated = false; ///< the scene has jumped since that was rendered: whatever comes shows before it
    bool moves = false; ///< something in the framelet that shows may move, and does not rest
    bool is_supersampled = false; ///< as `Piece::is_supersampled`
    bool is_wrong = false; ///< something nearer is there, which the viewer does not hold
    float stale = 0; ///< squared luma by which the moment was found to look otherwise

    bool is_shown() const { return share > 0; }
    float covered_share() const { return static_cast<float>(std::popcount(covered)) / cell_pixels; }
};

/// A square of cells around a position that show something else than is to be seen.
struct CellFault {
    Vec2 at{0}; ///< pixels
    int side = cell_side; ///< of the square of cells, pixels
    bool is_wrong = false; ///< as of `Cell`
    float stale = 0; ///< as of `Cell`
};

/// Bits [first, last) of a cell's side, clipped.
constexpr unsigned bits_between(int first, int last) {
    first = std::max(first, 0);
    last = std::min(last, cell_side);
    return ((1u << last) - 1) & ~((1u << first) - 1);
}

/// Moves bit r to the first bit of row r of a cell.
constexpr unsigned spread_rows(unsigned rows) {
    return (rows & 1) | (rows & 2) << 3 | (rows & 4) << 6 | (rows & 8) << 9;
}

/// Rows of cells [first, last).
struct CellRows {
    int first = 0, last = 0;
};

/// Calls `visit` with column, row and covered pixels (as of `Cell`) of each of the cells of these rows, `columns` each,
/// in which the box [low, high], pixels, covers centres of pixels.
template <class Visit>
void for_each_covered(Vec2 low, Vec2 high, int columns, CellRows rows, Visit visit) {
    low = glm::max(low - 0.5f, Vec2(0, rows.first) * float{cell_side});
    high = glm::min(high + 0.5f, Vec2(columns, rows.last) * float{cell_side});
    int const left = static_cast<int>(std::ceil(low.x));
    int const top = static_cast<int>(std::ceil(low.y));
    int const right = static_cast<int>(high.x);
    int const bottom = static_cast<int>(high.y);
    for (int row = top / cell_side; row * cell_side < bottom; ++row) {
        unsigned const down = spread_rows(bits_between(top - row * cell_side, bottom - row * cell_side));
        for (int column = left / cell_side; column * cell_side < right; ++column) {
            visit(column, row, down * bits_between(left - column * cell_side, right - column * cell_side));
        }
    }
}

} // namespace framelet
