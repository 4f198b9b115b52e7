// One plane for several that about agree: the least-squares fit to their values all over the rectangles in which they
// stand for something. In: planes and rectangles. Out: the fit, and how far it is from them.
#pragma once

#include <cmath>

namespace framelet {

/// A value that is affine on the image plane.
struct AffinePlane {
    double at = 0, dx = 0, dy = 0;

    double operator()(double x, double y) const { return at + dx * x + dy * y; }
};

/// Pixels.
struct PlaneExtent {
    double left = 0, top = 0, right = 0, bottom = 0;

    double middle_x() const { return 0.5 * (left + right); }
    double middle_y() const { return 0.5 * (top + bottom); }
};

/// Largest difference of two planes within a rectangle.
inline double largest_difference(AffinePlane const& a, AffinePlane const& b, PlaneExtent const& in) {
    AffinePlane const difference{a.at - b.at, a.dx - b.dx, a.dy - b.dy};
    return std::abs(difference(in.middle_x(), in.middle_y())) +
           0.5 * (std::abs(difference.dx) * (in.right - in.left) + std::abs(difference.dy) * (in.bottom - in.top));
}

inline double least_value(AffinePlane const& plane, PlaneExtent const& in) {
    return plane(in.middle_x(), in.middle_y()) -
           0.5 * (std::abs(plane.dx) * (in.right - in.left) + std::abs(plane.dy) * (in.bottom - in.top));
}

/// Integrals over rectangles, of which a fit is made; they add up.
struct PlaneSums {
    double area = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
    double value = 0, value_x = 0, value_y = 0;

    PlaneSums& operator+=(PlaneSums const& other) {
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

inline PlaneSums sums_over(AffinePlane const& plane, PlaneExtent const& extent) {
    double const width = extent.right - extent.left;
    double const height = extent.bottom - extent.top;
    double const area = width * height;
    double const x = extent.middle_x();
    double const y = extent.middle_y();
    double const value = plane(x, y);
    double const xx = width * width / 12; // about the middle
    double const yy = height * height / 12;
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
inline AffinePlane fit_plane(PlaneSums const& sums) {
    double const scale = 1 / sums.area;
    double const x = scale * sums.x;
    double const y = scale * sums.y;
    double const value = scale * sums.value;
    double const xx = scale * sums.xx - x * x;
    double const xy = scale * sums.xy - x * y;
    double const yy = scale * sums.yy - y * y;
    double const value_x = scale * sums.value_x - value * x;
    double const value_y = scale * sums.value_y - value * y;
    double const determinant = 1 / (xx * yy - xy * xy);
    double const dx = (value_x * yy - value_y * xy) * determinant;
    double const dy = (value_y * xx - value_x * xy) * determinant;
    return {value - dx * x - dy * y, dx, dy};
}

} // namespace framelet
