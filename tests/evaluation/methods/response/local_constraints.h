// Determines what one element asks for within its own bounds ([Stephens 2011] section 6.2). In: its density and
// sample-rate error. Out: in which direction it moves, and by how much its combined density would change.
#pragma once

#include "tests/evaluation/methods/response/density.h"
#include "tests/evaluation/methods/response/rate_error.h"

namespace framelet {

/// Change of combined density that an element asks for.
struct LocalResponse {
    Density direction; ///< m, of unit length (eq. 6.8); 0 where there is no error
    double change = 0; ///< dT* (eq. 6.16)

    bool operator==(LocalResponse const&) const = default;
};

/// The proportional response: a step along m by gain * |error|, up to where a bound is met (eq. 6.11 to 6.15). The area
/// along the ray is T + L k + Q k^2 with L = as mt + at ms and Q = ms mt. Eq. 6.12 misprints the subscripts, and of its
/// four distances only those to the bounds that m points at count. `at` lies within the bounds; `gain` >= 0, density
/// per unit of error.
LocalResponse respond_locally(Density at, RateError error, DensityBounds const& bounds, double gain);

} // namespace framelet
