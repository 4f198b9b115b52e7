#include "protocol/codec/color/point_grids.h"

#include <bit>

namespace framelet {

void PointGrids::fill(int width, int height, std::uint8_t value) {
    width_ = width;
    height_ = height;
    std::size_t values = 0;
    for (int level = 0; level < levels; ++level) {
        first_[static_cast<std::size_t>(level)] = values;
        std::size_t const size = stride(level) * static_cast<std::size_t>(height >> level);
        values += (size + cache_line - 1) / cache_line * cache_line;
    }
    constexpr std::size_t behind = 1; // lines: a row that is read may reach farther than what is needed of it
    Line line;
    line.values.fill(value);
    for (Lines& plane : planes_) {
        plane.assign(values / cache_line + behind, line);
    }
    line.values.fill(levels - 1);
    std::size_t const cells = cell_at(0, height);
    cells_.assign(cells / cache_line + 1 + behind, line);
}

namespace {

/// Sets so many cells to a side as `Cells` has bytes.
template <typename Cells>
void set_cells(std::uint8_t* to, std::size_t stride, std::uint8_t level) {
    Cells const all = Cells{} + level;
    for (std::size_t y = 0; y < sizeof(Cells); ++y, to += stride) {
        std::memcpy(to, &all, sizeof all);
    }
}

template <std::size_t side>
struct CellsOf {
    using Row [[gnu::vector_size(side)]] = std::uint8_t;
};

} // namespace

void PointGrids::set_level(int level, int left, int top, int side) {
    std::uint8_t* const to = bytes(cells_) + cell_at(left, top);
    auto const stride = static_cast<std::size_t>(width_ >> cell_bits);
    auto const value = static_cast<std::uint8_t>(level);
    switch (side >> cell_bits) {
    case 1:
        return set_cells<CellsOf<1>::Row>(to, stride, value);
    case 2:
        return set_cells<CellsOf<2>::Row>(to, stride, value);
    case 4:
        return set_cells<CellsOf<4>::Row>(to, stride, value);
    case 8:
        return set_cells<CellsOf<8>::Row>(to, stride, value);
    case 16:
        return set_cells<CellsOf<16>::Row>(to, stride, value);
    default:
        return set_cells<CellsOf<32>::Row>(to, stride, value);
    }
}

int PointGrids::level_in(int left, int top, int side) const {
    constexpr std::size_t at_a_time = sizeof(std::uint64_t);
    std::size_t const count = cell_at(left + side - 1, 0) - cell_at(left, 0) + 1;
    std::uint64_t const last = ~std::uint64_t{0} >> (8 * ((at_a_time - count % at_a_time) % at_a_time));
    std::uint8_t const* row = bytes(cells_) + cell_at(left, top);
    std::uint8_t const level = *row;
    std::uint64_t const all = level * 0x0101010101010101u;
    for (int y = top & -cell_side; y < top + side; y += cell_side, row += width_ >> cell_bits) {
        std::uint64_t others = 0;
        for (std::size_t i = 0; i < count; i += at_a_time) {
            std::uint64_t some;
            std::memcpy(&some, row + i, sizeof some);
            others |= (some ^ all) & (i + at_a_time >= count ? last : ~std::uint64_t{0});
        }
        if (others != 0) {
            return mixed_levels;
        }
    }
    return level;
}

void PointRows::find_levels(int y) {
    cell_row_ = y >> PointGrids::cell_bits;
    levels_ = point_rows::rows_of<1>({grids_.cells(y)}, x_, pitch_, PointGrids::cell_bits + twice_)[0];
    there_ = 0;
    for (int i = 0; i < framelet_side; ++i) {
        there_ |= 1u << levels_[i];
    }
    level_ = std::has_single_bit(there_) ? std::countr_zero(there_) : PointGrids::mixed_levels;
}

PointRows::Rows PointRows::mixed(int y) const {
    Rows out{};
    for (unsigned left = there_; left != 0; left &= left - 1) {
        int const level = std::countr_zero(left);
        auto const is_it = levels_ == static_cast<std::uint8_t>(level);
        Rows const rows = of_level(level, y);
        for (std::size_t plane = 0; plane < out.size(); ++plane) {
            out[plane] = is_it ? rows[plane] : out[plane];
        }
    }
    return out;
}

} // namespace framelet
