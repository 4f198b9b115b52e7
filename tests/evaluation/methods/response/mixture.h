// Splits an element's change of combined density between space and time ([Stephens 2011] section 6.4).
#pragma once

#include "tests/evaluation/methods/response/density.h"

namespace framelet {

/// The first point on the ray at + k * direction, k >= 0, whose area is that of `at` plus `change`: the smallest root
/// of Q k^2 + L k - change = 0, as -(L + sign(L) sqrt(L^2 + 4 Q change)) / 2 over Q or the other way round, which does
/// not cancel as Q goes to 0 (eq. 6.56 does). `change` lies between 0 and the element's limit (LocalResponse), so that
/// such a point is within the bounds; its area is exact but for rounding.
Density mix(Density at, Density direction, double change, DensityBounds const& bounds);

/// Slides along the curve of equal area for a bias of fidelity: `octaves` > 0 doubles space and halves time so often,
/// < 0 the other way round, as far as the bounds allow.
Density slide(Density at, double octaves, DensityBounds const& bounds);

} // namespace framelet
