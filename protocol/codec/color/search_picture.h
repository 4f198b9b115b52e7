// The picture that motion search looks in: green of the reference picture, all of it points of one spacing, so that any
// place is read alike, and again with every fourth point of every fourth row, for coarse framelets. In: framelets as
// the reference picture takes them. Out: rows of points.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/framelet/tile.h"
#include "protocol/codec/color/point_grids.h"

namespace framelet {

/// The picture has four values a pixel, and a quarter of one for the coarse points. What is coarse is written to the
/// coarse points alone, until something finer is looked for or written in its place.
class SearchPicture {
public:
    using Samples = std::array<std::uint8_t, framelet_samples>;

    /// Points from one coarse point to the next.
    static constexpr int coarse = 4;
    /// True for squares that are searched among the coarse points, by how many points they have to a side.
    static constexpr bool is_coarse(int side) { return side > coarse * framelet_side; }

    /// Copies one plane of the grids, and its size.
    void copy(PointGrids const& grids, std::size_t plane);
    bool is_kept() const { return width_ != 0; }

    /// Each point gets the sample that covers it, or the mean of those that it covers; where `is_coarse(side)` only
    /// each coarse point does. Left, top and side: points.
    void write(Samples const& samples, int left, int top, int side);

    /// Must be called before vectors of a framelet in this square are searched. What lies farther away may be found as
    /// it was when it was last prepared or finely written, so that sometimes the worse of two vectors is taken.
    void prepare(int left, int top, int side);

    struct Source {
        std::uint8_t const* first;
        std::size_t stride; ///< from one row to the next
    };
    /// Source from which a square is read: its coarse points where `is_coarse(side)`, else all of them.
    Source source(int left, int top, int side) const {
        return is_coarse(side) ? Source{&coarse_values_[coarse_at(left, top)], coarse_stride()}
                               : Source{values() + at(left, top), static_cast<std::size_t>(width_)};
    }

    /// Says that what lies near there will be asked for soon.
    void expect(int left, int top, int side) const;

private:
    /// Unit of alignment: no row of a tile reaches over the end of a line of the cache.
    struct alignas(cache_line) Line {
        std::array<std::uint8_t, cache_line> values;
    };
    /// Side of a block, points. Of a block either all points are known, or the coarse ones alone.
    static constexpr int block_side = coarse * framelet_side;

    std::size_t at(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }
    std::size_t coarse_stride() const { return static_cast<std::size_t>(width_ / coarse); }
    std::size_t coarse_at(int x, int y) const {
        return static_cast<std::size_t>(y / coarse) * coarse_stride() + static_cast<std::size_t>(x / coarse);
    }
    int block_columns() const { return (width_ + block_side - 1) / block_side; }
    int block_rows() const { return (height_ + block_side - 1) / block_side; }
    std::uint8_t& is_coarse_only(int column, int row) {
        return coarse_only_[static_cast<std::size_t>(row * block_columns() + column)];
    }
    std::uint8_t* values() { return reinterpret_cast<std::uint8_t*>(values_.data()); }
    std::uint8_t const* values() const { return reinterpret_cast<std::uint8_t const*>(values_.data()); }
    void put_coarse_points(int left, int top, int side);
    void spread(int column, int row);

    int width_ = 0, height_ = 0; ///< points
    std::vector<Line> values_;
    std::vector<std::uint8_t> coarse_values_;
    std::vector<std::uint8_t> coarse_only_; ///< for each block, in rows: the coarse points alone are known
};

} // namespace framelet
