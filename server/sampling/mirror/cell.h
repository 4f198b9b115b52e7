// Cells: squares of a few pixels of the picture, by which the server knows what a viewer shows there. In: a box of the
// picture. Out: the cells and the pixels in them that it covers.
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
    float inverse_depth = -1; ///< of the nearest surface that covers most of it, in its middle, 1 / metres
    float worn = 0; ///< least worn spacing on it, pixels; 0 where nothing shows
    float detail = 0; ///< as of a piece, in this picture's pixels
    float spacing = 0, decorrelation = 0; ///< of the piece
    std::uint32_t piece = 0; ///< of its moment
    std::uint16_t covered = 0; ///< by anything: a bit for each pixel, row by row
    std::uint8_t moment = 0; ///< slot
    std::uint8_t share = 0; ///< of its pixels that what shows covers, of 16
    bool leads = false; ///< as the viewer has it, before what is better
    bool is_outdated = false; ///< the scene has jumped since: whatever comes shows before it
    bool moves = false; ///< something of its framelet may, and does not rest
    bool is_supersampled = false; ///< as of a piece
    bool is_wrong = false; ///< something nearer is there, which the viewer does not hold
    float stale = 0; ///< squared luma by which the moment was found to look otherwise

    bool is_shown() const { return share > 0; }
    float covered_share() const { return static_cast<float>(std::popcount(covered)) / cell_pixels; }
};

/// Cells around a position that show something else than is to be seen.
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

/// Each bit of a cell's side to the first of its row.
constexpr unsigned spread_rows(unsigned rows) {
    return (rows & 1) | (rows & 2) << 3 | (rows & 4) << 6 | (rows & 8) << 9;
}

/// Calls `visit` with column, row and covered pixels (as of `Cell`) of each of so many cells of which a box [low, high]
/// covers the centres of pixels.
template <class Visit>
void for_each_covered(Vec2 low, Vec2 high, int columns, int rows, Visit visit) {
    low = glm::max(low - 0.5f, Vec2(0));
    high = glm::min(high + 0.5f, Vec2(columns, rows) * float{cell_side});
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
