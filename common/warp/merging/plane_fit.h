// Fits one plane to several that about agree, by least squares to their values all over the rectangles in which they
// stand for something. In: pieces of planes. Out: the fit, and how far it is from them. Numbers are doubles, or lanes
// of them where several are worked on at a time.
#pragma once

#include "common/simd/lanes.h"

namespace framelet {

/// A value that is affine on the image plane.
template <class Number>
struct AffineOf {
    Number at{}, dx{}, dy{};

    Number operator()(Number x, Number y) const { return at + dx * x + dy * y; }
};

/// A rectangle, pixels.
template <class Number>
struct ExtentOf {
    Number left{}, top{}, right{}, bottom{};
};

template <class Number>
ExtentOf<Number> united(ExtentOf<Number> const& a, ExtentOf<Number> const& b) {
    return {smaller(a.left, b.left), smaller(a.top, b.top), larger(a.right, b.right), larger(a.bottom, b.bottom)};
}

/// A plane within a rectangle.
template <class Number>
struct PieceOf {
    Number x{}, y{}; ///< its middle, pixels
    Number half_width{}, half_height{};
    Number value{}, dx{}, dy{}; ///< of the plane, in the middle

    AffineOf<Number> plane() const { return {value - dx * x - dy * y, dx, dy}; }
    ExtentOf<Number> extent() const { return {x - half_width, y - half_height, x + half_width, y + half_height}; }
};

template <class Number>
PieceOf<Number> piece_of(AffineOf<Number> const& plane, ExtentOf<Number> const& extent) {
    Number const x = 0.5 * (extent.left + extent.right);
    Number const y = 0.5 * (extent.top + extent.bottom);
    return {x,        y,       0.5 * (extent.right - extent.left), 0.5 * (extent.bottom - extent.top), plane(x, y),
            plane.dx, plane.dy};
}

/// Largest difference of a piece from a plane, within the piece's rectangle.
template <class Number>
Number largest_difference(PieceOf<Number> const& piece, AffineOf<Number> const& plane) {
    return absolute(plane(piece.x, piece.y) - piece.value) + absolute(plane.dx - piece.dx) * piece.half_width +
           absolute(plane.dy - piece.dy) * piece.half_height;
}

/// The least value of a plane within the piece's rectangle.
template <class Number>
Number least_value(AffineOf<Number> const& plane, PieceOf<Number> const& piece) {
    return plane(piece.x, piece.y) - absolute(plane.dx) * piece.half_width - absolute(plane.dy) * piece.half_height;
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
SumsOf<Number> sums_over(PieceOf<Number> const& piece) {
    Number const x = piece.x;
    Number const y = piece.y;
    Number const area = 4 * piece.half_width * piece.half_height;
    Number const xx = piece.half_width * piece.half_width / 3; // about the middle
    Number const yy = piece.half_height * piece.half_height / 3;
    return {area,
            area * x,
            area * y,
            area * (x * x + xx),
            area * x * y,
            area * (y * y + yy),
            area * piece.value,
            area * (piece.value * x + piece.dx * xx),
            area * (piece.value * y + piece.dy * yy)};
}

/// The plane that fits sums over some area.
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
using PlanePiece = PieceOf<double>;
using PlaneSums = SumsOf<double>;

} // namespace framelet
