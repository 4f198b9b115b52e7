#include "common/four_joining.h"

#include "common/morton.h"

namespace framelet {

namespace {

using Floats = float __attribute__((vector_size(4 * wide_doubles)));
using Ints = std::int32_t __attribute__((vector_size(4 * wide_doubles)));

WideDoubles doubles_of(Floats values) {
    return __builtin_convertvector(values, WideDoubles);
}
WideDoubles doubles_of(Ints values) {
    return __builtin_convertvector(values, WideDoubles);
}

/// Columns or rows of framelets in the square.
constexpr auto places(std::uint32_t (*coordinate)(std::uint32_t)) {
    std::array<std::array<float, FourJoining::most_fours>, 4> out{};
    for (std::uint32_t i = 0; i < 4 * FourJoining::most_fours; ++i) {
        out[i % 4][i / 4] = static_cast<float>(coordinate(i));
    }
    return out;
}
constexpr auto columns = places(morton_x);
constexpr auto rows = places(morton_y);

/// Byte `i` of boxes, which is signed.
WideDoubles byte_of(Ints boxes, int i) {
    return doubles_of(boxes << (24 - 8 * i) >> 24);
}

} // namespace

void FourJoining::join(std::size_t count, SampleGrid const& grid) {
    for (std::size_t first = 0; first < count; first += wide_doubles) {
        join_lanes(first, grid);
    }
}

void FourJoining::join_lanes(std::size_t first, SampleGrid const& grid) {
    using Plane = AffineOf<WideDoubles>;
    using Extent = ExtentOf<WideDoubles>;
    auto const load = [first](auto const& row) { return doubles_of(load_lanes<Floats>(&row[first])); };
    std::array<Plane, 4> planes;
    std::array<Extent, 4> extents;
    SumsOf<WideDoubles> sums;
    WideDoubles cost_of_parts{};
    for (std::size_t k = 0; k < planes.size(); ++k) {
        WideDoubles const column = load(columns[k]);
        WideDoubles const row = load(rows[k]);
        planes[k] = plane_in_square(load(at_of_[k]), load(dx_of_[k]), load(dy_of_[k]), column, row, grid);
        Ints const box = load_lanes<Ints>(&boxes_[k][first]);
        WideDoubles const left = grid.side * column;
        WideDoubles const top = grid.side * row;
        extents[k] = {grid.spacing * (left + byte_of(box, 0)), grid.spacing * (top + byte_of(box, 1)),
                      grid.spacing * (left + byte_of(box, 2) + 1), grid.spacing * (top + byte_of(box, 3) + 1)};
        sums += sums_over(planes[k], extents[k]);
        cost_of_parts += showing_cost(extents[k]);
    }
    Plane const plane = fit_plane(sums);
    WideDoubles const zero{};
    WideDoubles difference{}, share{};
    Extent extent = extents[0];
    auto is_joined = zero == zero;
    for (std::size_t k = 0; k < planes.size(); ++k) {
        WideDoubles const x = extents[k].middle_x();
        WideDoubles const y = extents[k].middle_y();
        WideDoubles const value = planes[k](x, y);
        WideDoubles const own = largest_difference(planes[k], plane, extents[k]);
        WideDoubles const own_share = own == 0 ? zero : own / least_value(plane, extents[k]);
        is_joined &= (absolute(planes[0](x, y) - value) <= hopeless * one_surface * value) & (own_share >= 0) &
                     (own_share <= one_surface);
        difference = larger(difference, own);
        share = larger(share, own_share);
        extent = united(extent, extents[k]);
    }
    is_joined &= showing_cost(extent) <= cost_of_parts;
    auto const store = [first](auto const& lanes, auto& row) { store_lanes(lanes, &row[first]); };
    store(is_joined, is_joined_);
    store(plane.at, at_);
    store(plane.dx, dx_);
    store(plane.dy, dy_);
    store(extent.left, left_);
    store(extent.top, top_);
    store(extent.right, right_);
    store(extent.bottom, bottom_);
    store(difference, difference_);
    store(share, share_);
    store(sums.area, sums_[0]);
    store(sums.x, sums_[1]);
    store(sums.y, sums_[2]);
    store(sums.xx, sums_[3]);
    store(sums.xy, sums_[4]);
    store(sums.yy, sums_[5]);
    store(sums.value, sums_[6]);
    store(sums.value_x, sums_[7]);
    store(sums.value_y, sums_[8]);
}

PlaneSums FourJoining::sums(std::size_t four) const {
    auto const sum = [&](std::size_t i) { return sums_[i][four]; };
    return {sum(0), sum(1), sum(2), sum(3), sum(4), sum(5), sum(6), sum(7), sum(8)};
}

} // namespace framelet
