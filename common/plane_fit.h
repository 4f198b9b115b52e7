// One plane for several that about agree: the least-squares fit to their values all over the rectangles in which they
// stand for something. In: planes and rectangles. Out: the fit, and how far it is from them. Numbers are doubles, or
// lanes of them where several are fitted at a time.
#pragma once

#include "common/lanes.h"

namespace framelet {

/// A value that is affine on the image plane.
template <class Number>
struct AffineOf {
    Number at{}, dx{}, dy{};

    Number operator()(Number x, Number y) const { return at + dx * x + dy * y; }
};

/// Pixels.
template <class Number>
struct ExtentOf {
    Number left{}, top{}, right{}, bottom{};

    Number middle_x() const { return 0.5 * (left + right); }
    Number middle_y() const { return 0.5 * (top + bottom); }
};

template <class Number>
ExtentOf<Number> united(ExtentOf<Number> const& a, ExtentOf<Number> const& b) {
    return {smaller(a.left, b.left), smaller(a.top, b.top), larger(a.right, b.right), larger(a.bottom, b.bottom)};
}

/// Largest difference of two planes within a rectangle.
template <class Number>
Number largest_difference(AffineOf<Number> const& a, AffineOf<Number> const& b, ExtentOf<Number> const& in) {
    AffineOf<Number> const difference{a.at - b.at, a.dx - b.dx, a.dy - b.dy};
    return absolute(difference(in.middle_x(), in.middle_y())) +
           0.5 * (absolute(difference.dx) * (in.right - in.left) + absolute(difference.dy) * (in.bottom - in.top));
}

template <class Number>
Number least_value(AffineOf<Number> const& plane, ExtentOf<Number> const& in) {
    return plane(in.middle_x(), in.middle_y()) -
           0.5 * (absolute(plane.dx) * (in.right - in.left) + absolute(plane.dy) * (in.bottom - in.top));
}

/// Integrals over rectangles, of which a fit is made; they add up.
template <class Number>
struct SumsOf {
    Number area{}, x{}, y{}, xx{}, xy{}, yy{};
    Number value{}, value_x{}, value_y{};

    SumsOf& operator+=(SumsOf const& other) {
        area += other.area;
        x += other.x;
        y += other.y;
        xx += other.xx;
        xy += other.xy;
        yy += other.yy;
        value += other.value;
        value_x += other.value_x;
        value_y += other.value_y;
        return *this;
    }
};

template <class Number>
SumsOf<Number> sums_over(AffineOf<Number> const& plane, ExtentOf<Number> const& extent) {
    Number const width = extent.right - extent.left;
    Number const height = extent.bottom - extent.top;
    Number const area = width * height;
    Number const x = extent.middle_x();
    Number const y = extent.middle_y();
    Number const value = plane(x, y);
    Number const xx = width * width / 12; // about the middle
    Number const yy = height * height / 12;
    return {area,
            area * x,
            area * y,
            area * (x * x + xx),
            area * x * y,
            area * (y * y + yy),
            area * value,
            area * (value * x + plane.dx * xx),
            area * (value * y + plane.dy * yy)};
}

/// Of sums over some area.
template <class Number>
AffineOf<Number> fit_plane(SumsOf<Number> const& sums) {
    Number const scale = 1 / sums.area;
    Number const x = scale * sums.x;
    Number const y = scale * sums.y;
    Number const value = scale * sums.value;
    Number const xx = scale * sums.xx - x * x;
    Number const xy = scale * sums.xy - x * y;
    Number const yy = scale * sums.yy - y * y;
    Number const value_x = scale * sums.value_x - value * x;
    Number const value_y = scale * sums.value_y - value * y;
    Number const determinant = 1 / (xx * yy - xy * xy);
    Number const dx = (value_x * yy - value_y * xy) * determinant;
    Number const dy = (value_y * xx - value_x * xy) * determinant;
    return {value - dx * x - dy * y, dx, dy};
}

using AffinePlane = AffineOf<double>;
using PlaneExtent = ExtentOf<double>;
using PlaneSums = SumsOf<double>;

} // namespace framelet
