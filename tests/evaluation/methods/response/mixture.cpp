#include "tests/evaluation/methods/response/mixture.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace framelet {
namespace {

constexpr double nowhere = std::numeric_limits<double>::infinity();

double at_least_zero(double root) {
    return root >= 0 ? root : nowhere; // NaN becomes `nowhere` too
}

double smallest_root(double square, double linear, double constant) {
    double const discriminant = std::max(0.0, linear * linear - 4 * square * constant);
    double const q = -0.5 * (linear + std::copysign(std::sqrt(discriminant), linear));
    return std::min(at_least_zero(q / square), at_least_zero(constant / q));
}

} // namespace

Density mix(Density at, Density direction, double change, DensityBounds const& bounds) {
    if (change == 0) {
        return at;
    }
    double const linear = at.space * direction.time + at.time * direction.space;
    double const k = smallest_root(direction.space * direction.time, linear, -change);
    if (k == nowhere) {
        return at;
    }
    // Rounding may put the point off its curve or beyond a bound: take one coordinate from the ray, the other from the
    // curve; if that one is cut, the first again from the curve.
    double const area = at.area() + change;
    auto const cut = [](double value, double least, double most) { return std::clamp(value, least, most); };
    double space = cut(at.space + k * direction.space, bounds.least.space, bounds.most.space);
    double const time = cut(area / space, bounds.least.time, bounds.most.time);
    space = cut(area / time, bounds.least.space, bounds.most.space);
    return {space, time};
}

Density slide(Density at, double octaves, DensityBounds const& bounds) {
    if (octaves == 0) {
        return at;
    }
    bool const to_space = octaves > 0;
    double const reach = to_space ? std::min(bounds.most.space / at.space, at.time / bounds.least.time)
                                  : std::min(bounds.most.time / at.time, at.space / bounds.least.space);
    double const factor = std::clamp(std::exp2(std::abs(octaves)), 1.0, std::max(1.0, reach));
    Density const moved =
        to_space ? Density{at.space * factor, at.time / factor} : Density{at.space / factor, at.time * factor};
    return {std::clamp(moved.space, bounds.least.space, bounds.most.space),
            std::clamp(moved.time, bounds.least.time, bounds.most.time)};
}

} // namespace framelet
