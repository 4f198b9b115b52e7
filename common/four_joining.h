// Framelets of one layer each: which four of them that share a parent are about one plane, for several fours at a time,
// one in each lane. In: layers as they are held. Out: the fits, and how far they are from what they were made of.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "common/held_shape.h"
#include "common/plane_fit.h"

namespace framelet {

/// Inverse depths that differ by less than this share are the same for all that looks at them.
inline constexpr double one_surface = 2e-3;

/// A layer this many times the tolerance off, where it lies, is not worth a fit.
inline constexpr double hopeless = 2;

/// What it costs to show what lies there, in pixels: blocks and lanes reach beyond it.
template <class Number>
Number showing_cost(ExtentOf<Number> const& extent) {
    return (extent.right - extent.left + 12) * (extent.bottom - extent.top + 6);
}

/// Layers of framelets of a square, which have `side` x `side` samples, `spacing` pixels apart.
struct SampleGrid {
    int side = framelet_side;
    double spacing = 1;
};

/// From the square's corner on; `column` and `row` are the framelet's. Numbers are doubles or lanes.
template <class Number>
AffineOf<Number> plane_in_square(Number at, Number dx, Number dy, Number column, Number row, SampleGrid const& grid) {
    return {at - grid.side * grid.spacing * (dx * column + dy * row), dx, dy};
}

/// Of all framelets of a square.
class FourJoining {
public:
    static constexpr std::size_t most_fours = 16;

    /// Of a framelet, in Morton order below the square.
    void set(std::size_t part, HeldLayer const& held) {
        std::size_t const quarter = part % 4;
        std::size_t const four = part / 4;
        at_of_[quarter][four] = held.layer.at;
        dx_of_[quarter][four] = held.layer.dx;
        dy_of_[quarter][four] = held.layer.dy;
        // Four bytes one after the other.
        static_assert(offsetof(HeldLayer, last_row) == offsetof(HeldLayer, first_column) + 3);
        std::memcpy(&boxes_[quarter][four], &held.first_column, sizeof(std::int32_t));
    }
    /// The first `count` fours; what is found of those that are not complete means nothing.
    void join(std::size_t count, SampleGrid const& grid);

    /// One plane is near enough to all four, and what holds them is no dearer than each.
    bool is_joined(std::size_t four) const { return is_joined_[four] != 0; }
    AffinePlane plane(std::size_t four) const { return {at_[four], dx_[four], dy_[four]}; }
    PlaneExtent extent(std::size_t four) const { return {left_[four], top_[four], right_[four], bottom_[four]}; }
    PlaneSums sums(std::size_t four) const;
    /// As in `JoinedLayer`.
    double difference(std::size_t four) const { return difference_[four]; }
    double share(std::size_t four) const { return share_[four]; }

private:
    template <class T>
    using RowOf = std::array<T, most_fours>;
    using Row = RowOf<double>;
    template <class T>
    using Quarters = std::array<RowOf<T>, 4>;

    void join_lanes(std::size_t first, SampleGrid const& grid);

    alignas(64) Quarters<float> at_of_{}, dx_of_{}, dy_of_{};
    alignas(64) Quarters<std::int32_t> boxes_{}; ///< bytes as in `HeldLayer`, lowest first
    alignas(64) Row at_{}, dx_{}, dy_{}, left_{}, top_{}, right_{}, bottom_{}, difference_{}, share_{};
    alignas(64) std::array<Row, 9> sums_{};
    alignas(64) std::array<std::int64_t, most_fours> is_joined_{};
};

} // namespace framelet
