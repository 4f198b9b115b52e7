// The response decision ([Stephens 2011] chapter 6) in its three stages: local constraints, transport, mixture. In:
// sample density and the errors of some elements. Out: the new density, of the same integral.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tests/evaluation/methods/response/density_field.h"
#include "tests/evaluation/methods/response/local_constraints.h"

namespace framelet {

struct ResponseParameters {
    DensityBounds bounds; ///< samples per pixel; refreshes per second
    double gain = 0.1; ///< length of the step that an error of 1 asks for, samples per pixel
    /// Refreshes per second that are as long a step as one sample per pixel: a ray needs one measure for both axes.
    double rate_unit = 1;
    double bias = 0; ///< octaves by which an error of 1 slides density from time (> 0) or from space (< 0)
};

/// Memory reused from cycle to cycle, so that nothing is allocated.
struct ResponseScratch {
    std::vector<Density> directions;
    std::vector<double> changes;
};

/// Changes the density by one cycle's errors. `errors[i]` belongs to element `elements[i]` of the density; each element
/// comes once at most, those without error need not come.
void respond(DensityField& density, std::span<std::uint32_t const> elements, std::span<RateError const> errors,
             ResponseParameters const& parameters, ResponseScratch& scratch);

} // namespace framelet
