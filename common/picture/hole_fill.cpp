#include "common/picture/hole_fill.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "common/color.h"
#include "common/picture/reconstruction.h"
#include "common/warp/patch_sampling.h"

namespace framelet {

namespace {

constexpr int block_side = WarpedBlock::side;

/// Cells of a coarse row, one for each of the n cells of a finer one.
template <int n>
struct Row {
    alignas(64) std::array<float, static_cast<std::size_t>(n)> red, green, blue, inverse_depth;

    template <int m, class Column>
    void spread(FarGrid<m> const& coarse, int row, Column const& column) {
        for (int x = 0; x < n; ++x) {
            auto const from = static_cast<std::size_t>(row * m + column(x));
            auto const to = static_cast<std::size_t>(x);
            red[to] = coarse.red[from];
            green[to] = coarse.green[from];
            blue[to] = coarse.blue[from];
            inverse_depth[to] = coarse.inverse_depth[from];
        }
    }
};

/// Values for n x n fine cells: interpolated between those of the four coarse cells around each that are about as far
/// as the farthest. Where those are nothing (no picture at all) the value is nothing, too. `parent` and `other` give
/// the coarse column (or row) that a fine one lies in and the nearest other one. (No branch depends on a cell: eight
/// are worked on at a time. A coarse row is spread once for all fine rows that lie in it or beside it.)
template <int n, int m>
class Pushed {
public:
    template <class Parent, class Other>
    Pushed(FarGrid<m> const& coarse, int first, int last, Parent const& parent, Other const& other) {
        for (int row = std::min(parent(first), other(first)); row <= std::max(parent(last), other(last)); ++row) {
            own_[static_cast<std::size_t>(row)].spread(coarse, row, parent);
            beside_[static_cast<std::size_t>(row)].spread(coarse, row, other);
        }
    }

    /// Computes the cells of one fine row from `first` on and before `last`.
    void row(int parent, int other, std::size_t first, std::size_t last, Row<n>& out) const {
        Row<n> const& own = own_[static_cast<std::size_t>(parent)];
        Row<n> const& beside = beside_[static_cast<std::size_t>(parent)];
        Row<n> const& above = own_[static_cast<std::size_t>(other)];
        Row<n> const& across = beside_[static_cast<std::size_t>(other)];
        for (std::size_t x = first; x < last; ++x) {
            FarthestOfFour<float> const four({9, 3, 3, 1}, own.inverse_depth[x], beside.inverse_depth[x],
                                             above.inverse_depth[x], across.inverse_depth[x]);
            out.red[x] = four.mean(own.red[x], beside.red[x], above.red[x], across.red[x]);
            out.green[x] = four.mean(own.green[x], beside.green[x], above.green[x], across.green[x]);
            out.blue[x] = four.mean(own.blue[x], beside.blue[x], above.blue[x], across.blue[x]);
            out.inverse_depth[x] = four.farthest;
        }
    }

private:
    std::array<Row<n>, static_cast<std::size_t>(m)> own_, beside_;
};

/// Gives fine cells with nothing in them a value. Cells within the margin are not needed.
template <int margin, int n, int m, class Parent, class Other>
void push(FarGrid<m> const& coarse, FarGrid<n>& fine, Parent const& parent, Other const& other) {
    Pushed<n, m> const pushed(coarse, margin, n - margin - 1, parent, other);
    Row<n> row;
    for (int y = margin; y < n - margin; ++y) {
        pushed.row(parent(y), other(y), margin, n - margin, row);
        for (std::size_t x = margin; x < n - margin; ++x) {
            std::size_t const to = static_cast<std::size_t>(y * n) + x;
            bool const nothing = is_nothing(fine.inverse_depth[to]);
            fine.red[to] = nothing ? row.red[x] : fine.red[to];
            fine.green[to] = nothing ? row.green[x] : fine.green[to];
            fine.blue[to] = nothing ? row.blue[x] : fine.blue[to];
            fine.inverse_depth[to] = nothing ? row.inverse_depth[x] : fine.inverse_depth[to];
        }
    }
}

template <int margin, int n>
void push(FarGrid<n / 2> const& coarse, FarGrid<n>& fine) {
    push<margin>(
        coarse, fine, [](int i) { return i / 2; },
        [](int i) { return std::clamp(i / 2 + (i % 2 == 0 ? -1 : 1), 0, n / 2 - 1); });
}

/// Reads a block's pixels; those outside of the picture are holes.
void read_block(std::span<float const> inverse_depth, Picture const& picture, int left, int top, FarGrid<16>& block) {
    auto const width = static_cast<std::size_t>(std::min(block_side, picture.width - left));
    for (int y = 0; y < block_side; ++y) {
        alignas(32) std::array<std::uint32_t, block_side> colors{};
        alignas(32) std::array<float, block_side> depths;
        depths.fill(hole_depth);
        std::size_t const from = static_cast<std::size_t>(top + y) * static_cast<std::size_t>(picture.width) +
                                 static_cast<std::size_t>(left);
        if (top + y < picture.height && width == block_side) {
            std::memcpy(colors.data(), picture.rgba.data() + 4 * from, sizeof colors); // of a size that is known
            std::memcpy(depths.data(), inverse_depth.data() + from, sizeof depths);
        } else if (top + y < picture.height) {
            std::memcpy(colors.data(), picture.rgba.data() + 4 * from, 4 * width);
            std::memcpy(depths.data(), inverse_depth.data() + from, 4 * width);
        }
        auto const to = static_cast<std::size_t>(y * block_side);
        for (std::size_t x = 0; x < block_side; ++x) {
            bool const shows = depths[x] > hole_depth;
            std::uint32_t const color = shows ? colors[x] : 0u;
            block.red[to + x] = square(red_of(color));
            block.green[to + x] = square(green_of(color));
            block.blue[to + x] = square(blue_of(color));
            block.inverse_depth[to + x] = shows ? depths[x] : FarMean::nothing;
        }
    }
}

/// Cells of a block outside of the picture.
FarCells const no_cells = [] {
    FarCells out{};
    out.level1.inverse_depth.fill(FarMean::nothing);
    out.level2.inverse_depth.fill(FarMean::nothing);
    out.level3.inverse_depth.fill(FarMean::nothing);
    return out;
}();

/// The cells of blocks in a picture.
struct CellsAround {
    std::span<FarCells const> cells;
    int columns, rows; ///< of blocks
    int column, row; ///< the one in the middle

    FarCells const& at(int dx, int dy) const {
        int const x = column + dx;
        int const y = row + dy;
        bool const inside = x >= 0 && y >= 0 && x < columns && y < rows;
        return inside ? cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
                              static_cast<std::size_t>(x)]
                      : no_cells;
    }
};

/// Reads the part of the window that the blocks `dx` to the right of the middle give; its width is one that the
/// compiler knows.
template <int margin, int n, int dx>
void read_column(CellsAround const& around, FarGrid<n / 2> FarCells::*level, FarGrid<n>& window) {
    constexpr int side = n / 2; // cells of a block
    constexpr int before = side / 2; // of the window, before the block
    constexpr int x0 = std::max(margin, before + dx * side);
    constexpr auto count = static_cast<std::size_t>(std::min(n - margin, before + (dx + 1) * side) - x0);
    for (int dy = -1; dy <= 1; ++dy) {
        int const y0 = std::max(margin, before + dy * side);
        int const y1 = std::min(n - margin, before + (dy + 1) * side);
        FarGrid<n / 2> const& block = around.at(dx, dy).*level;
        for (int y = y0; y < y1; ++y) {
            auto const from = static_cast<std::size_t>((y - before - dy * side) * side + x0 - before - dx * side);
            auto const to = static_cast<std::size_t>(y * n + x0);
            for (std::size_t i = 0; i < count; ++i) {
                window.red[to + i] = block.red[from + i];
                window.green[to + i] = block.green[from + i];
                window.blue[to + i] = block.blue[from + i];
                window.inverse_depth[to + i] = block.inverse_depth[from + i];
            }
        }
    }
}

/// Reads the cells of a block and of half a block more on each side; those within the margin are not needed.
template <int margin, int n>
void read_window(CellsAround const& around, FarGrid<n / 2> FarCells::*level, FarGrid<n>& window) {
    read_column<margin, n, -1>(around, level, window);
    read_column<margin, n, 0>(around, level, window);
    read_column<margin, n, 1>(around, level, window);
}

template <int margin, int n>
bool has_nothing(FarGrid<n> const& grid) {
    float most = 0;
    for (int y = margin; y < n - margin; ++y) {
        for (int x = margin; x < n - margin; ++x) {
            most = std::max(most, grid.inverse_depth[static_cast<std::size_t>(y * n + x)]);
        }
    }
    return is_nothing(most);
}

std::uint32_t byte_of(float square) {
    return static_cast<std::uint32_t>(
        static_cast<std::int32_t>(std::min(std::sqrt(std::max(square, 0.0f)) + 0.5f, 255.0f)));
}

/// Writes the holes of a block from the means of 2x2 pixels around it.
void write_holes(FarGrid<16> const& level1, std::span<float const> inverse_depth, int left, int top, Picture& picture) {
    auto const parent = [](int i) { return i / 2 + 4; };
    auto const other = [](int i) { return i / 2 + 4 + (i % 2 == 0 ? -1 : 1); };
    Pushed<16, 16> const pushed(level1, 0, block_side - 1, parent, other);
    std::uint32_t const gray = srgb_byte_from_linear(uncovered_light);
    std::uint32_t const uncovered = picture_pixel(gray, gray, gray);
    int const width = std::min(block_side, picture.width - left);
    Row<16> row;
    for (int y = 0; y < std::min(block_side, picture.height - top); ++y) {
        float const* const depth =
            inverse_depth.data() + static_cast<std::size_t>(top + y) * static_cast<std::size_t>(picture.width) + left;
        float least = INFINITY;
        for (int x = 0; x < width; ++x) {
            least = std::min(least, depth[x]);
        }
        if (least > hole_depth) {
            continue;
        }
        pushed.row(parent(y), other(y), 0, block_side, row);
        std::array<std::uint32_t, block_side> colors;
        for (std::size_t x = 0; x < block_side; ++x) {
            std::uint32_t const color = picture_pixel(byte_of(row.red[x]), byte_of(row.green[x]), byte_of(row.blue[x]));
            colors[x] = is_nothing(row.inverse_depth[x]) ? uncovered : color;
        }
        std::uint8_t* const pixel = picture.row(top + y) + 4 * left;
        for (int x = 0; x < width; ++x) {
            if (!(depth[x] > hole_depth)) {
                std::memcpy(pixel + 4 * x, &colors[static_cast<std::size_t>(x)], sizeof colors[0]);
            }
        }
    }
}

} // namespace

FarCells far_cells(std::span<float const> inverse_depth, Picture const& picture, int column, int row) {
    FarGrid<16> pixels;
    FarCells out;
    read_block(inverse_depth, picture, column * block_side, row * block_side, pixels);
    pull(pixels, out.level1);
    pull(out.level1, out.level2);
    pull(out.level2, out.level3);
    return out;
}

void fill_holes(FarMeans const& means, std::span<FarCells const> cells, std::span<float const> inverse_depth,
                int column, int row, Picture& picture) {
    CellsAround const around{cells, (picture.width + block_side - 1) / block_side,
                             (picture.height + block_side - 1) / block_side, column, row};
    FarGrid<16> level1;
    read_window<3>(around, &FarCells::level1, level1);
    if (has_nothing<3>(level1)) {
        FarGrid<8> level2;
        FarGrid<4> level3;
        FarGrid<3> blocks;
        read_window<1>(around, &FarCells::level2, level2);
        read_window<0>(around, &FarCells::level3, level3);
        for (int y = 0; y < 3; ++y) {
            for (int x = 0; x < 3; ++x) {
                put(means.at(column + x - 1, row + y - 1), static_cast<std::size_t>(y * 3 + x), blocks);
            }
        }
        push<0>(
            blocks, level3, [](int i) { return (i + 1) / 2; },
            [](int i) { return (i + 1) / 2 + (i % 2 == 0 ? 1 : -1); });
        push<1>(level3, level2);
        push<3>(level2, level1);
    }
    write_holes(level1, inverse_depth, column * block_side, row * block_side, picture);
}

} // namespace framelet
