// Green of what a viewer holds, as its writer searches it: all of it points of one spacing, so that any place is read
// alike. In: framelets as the held picture takes them. Out: rows of points.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/tile.h"
#include "protocol/point_grids.h"

namespace framelet {

/// Four values a pixel.
class SearchPicture {
public:
    using Samples = std::array<std::uint8_t, framelet_samples>;

    /// What the grids have there.
    void copy(PointGrids const& grids, std::size_t plane);
    bool is_kept() const { return width_ != 0; }

    /// Each point gets the sample that covers it, or the mean of those that it covers. Left, top and side: points.
    void write(Samples const& samples, int left, int top, int side);

    struct Source {
        std::uint8_t const* first;
        std::size_t stride; ///< from one row to the next
        int pitch; ///< points from sample to sample; 0: two samples a point
    };
    Source source(int left, int top, int side) const {
        return {values() + at(left, top), static_cast<std::size_t>(width_), side / framelet_side};
    }

    /// Says that what lies near there will be asked for soon.
    void expect(int left, int top, int side) const;

private:
    /// Rows of coarse tiles are whole lines of the cache where they are written.
    struct alignas(cache_line) Line {
        std::array<std::uint8_t, cache_line> values;
    };

    std::size_t at(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }
    std::uint8_t* values() { return reinterpret_cast<std::uint8_t*>(values_.data()); }
    std::uint8_t const* values() const { return reinterpret_cast<std::uint8_t const*>(values_.data()); }

    int width_ = 0; ///< points
    std::vector<Line> values_;
};

} // namespace framelet
