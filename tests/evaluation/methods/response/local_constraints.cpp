#include "tests/evaluation/methods/response/local_constraints.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace framelet {
namespace {

double distance_to_bound(double at, double direction, double least, double most) {
    if (direction == 0) {
        return std::numeric_limits<double>::infinity();
    }
    return std::max(0.0, ((direction > 0 ? most : least) - at) / direction);
}

} // namespace

LocalResponse respond_locally(Density at, RateError error, DensityBounds const& bounds, double gain) {
    double const length = std::hypot(double(error.space), double(error.time));
    if (length == 0) {
        return {};
    }
    Density const m{error.space / length, error.time / length};
    double const farthest = std::min(distance_to_bound(at.space, m.space, bounds.least.space, bounds.most.space),
                                     distance_to_bound(at.time, m.time, bounds.least.time, bounds.most.time));
    double const linear = at.space * m.time + at.time * m.space;
    double const square = m.space * m.time;
    auto const change_at = [&](double k) { return k * (linear + k * square); };

    double const change = change_at(std::min(farthest, gain * length));
    return {m, change};
}

} // namespace framelet
