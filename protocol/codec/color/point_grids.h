// A plane of points that has been written coarsely here and finely there, without spreading what is coarse: each level
// is a grid of its own, and each cell of 8x8 points says which of them counts there. In: squares of 16x16 values of one
// level. Out: rows of points, wherever they lie.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "common/framelet/tile.h"

namespace framelet {

inline constexpr std::size_t cache_line = 64;

/// 16 values of a plane.
using PointRow [[gnu::vector_size(framelet_side)]] = std::uint8_t;

namespace point_rows {

inline PointRow load(std::uint8_t const* from) {
    PointRow row;
    std::memcpy(&row, from, sizeof row);
    return row;
}

/// Loads every n-th value, n = sizeof(Lane).
template <typename Lane>
PointRow every(std::uint8_t const* from) {
    using Lanes [[gnu::vector_size(framelet_side * sizeof(Lane))]] = Lane;
    Lanes values;
    std::memcpy(&values, from, sizeof values);
    return __builtin_convertvector(values, PointRow);
}

inline PointRow every_16th(std::uint8_t const* from) {
    PointRow row;
    for (int i = 0; i < framelet_side; ++i) {
        row[i] = from[i * framelet_side];
    }
    return row;
}

/// Loads values, each repeated n = sizeof(Lane) times, of which the first `skip` are left out.
template <typename Lane>
PointRow repeated(std::uint8_t const* from, std::size_t skip) {
    constexpr std::size_t lanes = 2 * framelet_side / sizeof(Lane); // more than are needed
    constexpr Lane ones = static_cast<Lane>(~std::uint64_t{0}) / 255;
    using Narrow [[gnu::vector_size(lanes)]] = std::uint8_t;
    using Lanes [[gnu::vector_size(2 * framelet_side)]] = Lane;
    Narrow values;
    std::memcpy(&values, from, sizeof values);
    Lanes const spread = __builtin_convertvector(values, Lanes) * ones;
    std::array<std::uint8_t, sizeof spread> bytes;
    std::memcpy(bytes.data(), &spread, sizeof spread);
    return load(bytes.data() + skip);
}

/// Reads the values numbered (first + i 2^pitch) / 2^level, i = 0..15, of several rows: those of 16 points, 2^pitch
/// apart.
template <std::size_t count>
[[gnu::always_inline]] inline std::array<PointRow, count> rows_of(std::array<std::uint8_t const*, count> const& rows,
                                                                  int first, int pitch, int level) {
    int const begin = first >> level;
    auto const each = [&](auto const& read) {
        std::array<PointRow, count> out;
        for (std::size_t i = 0; i < count; ++i) {
            out[i] = read(rows[i] + begin);
        }
        return out;
    };
    auto const skip = static_cast<std::size_t>((first >> pitch) & ((1 << std::max(level - pitch, 0)) - 1));
    switch (pitch - level) {
    case 0:
        return each(load);
    case 1:
        return each(every<std::uint16_t>);
    case 2:
        return each(every<std::uint32_t>);
    case 3:
        return each(every<std::uint64_t>);
    case 4:
        return each(every_16th);
    case -1:
        return each([skip](std::uint8_t const* from) { return repeated<std::uint16_t>(from, skip); });
    case -2:
        return each([skip](std::uint8_t const* from) { return repeated<std::uint32_t>(from, skip); });
    case -3:
        return each([skip](std::uint8_t const* from) { return repeated<std::uint64_t>(from, skip); });
    default:
        return each([&](std::uint8_t const* from) {
            PointRow out;
            for (int i = 0; i < framelet_side; ++i) {
                out[i] = from[((first + (i << pitch)) >> level) - begin];
            }
            return out;
        });
    }
}

} // namespace point_rows

/// Three planes of points, in each cell of which the same level counts.
class PointGrids {
public:
    /// Number of levels: level l has a value for every 2^l x 2^l points.
    static constexpr int levels = 5;
    static constexpr int cell_bits = 3, cell_side = 1 << cell_bits;
    static constexpr std::size_t planes = 3;

    /// Sets the size, points, both multiples of 32, and one value everywhere.
    void fill(int width, int height, std::uint8_t value);
    int width() const { return width_; }
    int height() const { return height_; }

    /// Makes this level count from now on in a square of `side` points, a multiple of 8, as are left and top.
    void set_level(int level, int left, int top, int side);

    struct Rows {
        std::uint8_t* first;
        std::size_t stride;
    };
    /// Address of the level's value for point (x, y), and the stride from there to the next row of the level.
    Rows rows(std::size_t plane, int level, int x, int y) {
        return {bytes(planes_[plane]) + at(level, x, y), stride(level)};
    }
    std::uint8_t const* value(std::size_t plane, int level, int x, int y) const {
        return bytes(planes_[plane]) + at(level, x, y);
    }
    std::array<std::uint8_t const*, planes> values(int level, int x, int y) const {
        std::size_t const to = at(level, x, y);
        return {bytes(planes_[0]) + to, bytes(planes_[1]) + to, bytes(planes_[2]) + to};
    }
    std::size_t stride(int level) const { return static_cast<std::size_t>(width_ >> level); }

    static constexpr int mixed_levels = -1;
    /// The level that counts in all of a square, or `mixed_levels`.
    int level_in(int left, int top, int side) const;
    int level_at(int x, int y) const { return bytes(cells_)[cell_at(x, y)]; }
    std::uint8_t const* cells(int y) const { return bytes(cells_) + cell_at(0, y); }

    bool operator==(PointGrids const&) const = default;

private:
    struct alignas(cache_line) Line {
        std::array<std::uint8_t, cache_line> values;
        bool operator==(Line const&) const = default;
    };
    using Lines = std::vector<Line>;

    static std::uint8_t* bytes(Lines& lines) { return reinterpret_cast<std::uint8_t*>(lines.data()); }
    static std::uint8_t const* bytes(Lines const& lines) { return reinterpret_cast<std::uint8_t const*>(lines.data()); }
    std::size_t at(int level, int x, int y) const {
        return first_[static_cast<std::size_t>(level)] + static_cast<std::size_t>(y >> level) * stride(level) +
               static_cast<std::size_t>(x >> level);
    }
    std::size_t cell_at(int x, int y) const {
        return static_cast<std::size_t>(y >> cell_bits) * static_cast<std::size_t>(width_ >> cell_bits) +
               static_cast<std::size_t>(x >> cell_bits);
    }

    int width_ = 0, height_ = 0; ///< points
    std::array<std::size_t, levels> first_{}; ///< where the values of each level begin in a plane
    std::array<Lines, planes> planes_; ///< rows from the top; behind the last, room to read a row
    Lines cells_; ///< level that counts in each cell, in rows
};

/// Reads 16 points of a row of each plane, 2^pitch apart from each other, x being that of the first. All of them are in
/// the plane; rows are best asked for in order. `level`: that which counts wherever rows will be asked for, or
/// `mixed_levels`. With `twice` 1 and pitch 0, eight points, each twice.
class PointRows {
public:
    PointRows(PointGrids const& grids, int x, int pitch, int level, int twice)
        : grids_(grids), x_(x << twice), pitch_(pitch), twice_(twice), level_(level),
          is_mixed_(level == PointGrids::mixed_levels) {}

    using Rows = std::array<PointRow, PointGrids::planes>;
    Rows at(int y) {
        if (is_mixed_ && y >> PointGrids::cell_bits != cell_row_) {
            find_levels(y);
        }
        return level_ != PointGrids::mixed_levels ? of_level(level_, y) : mixed(y);
    }

private:
    Rows of_level(int level, int y) const {
        return point_rows::rows_of(grids_.values(level, 0, y), x_, pitch_, level + twice_);
    }
    void find_levels(int y);
    Rows mixed(int y) const;

    PointGrids const& grids_;
    int x_, pitch_, twice_;
    int level_;
    bool is_mixed_;
    int cell_row_ = -1;
    PointRow levels_{}; ///< level that counts at each of the 16 points, in that row of cells
    unsigned there_ = 0; ///< bit l: level l is among these
};

} // namespace framelet
