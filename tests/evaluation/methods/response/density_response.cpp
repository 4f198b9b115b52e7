#include "tests/evaluation/methods/response/density_response.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "tests/evaluation/methods/response/mixture.h"
#include "tests/evaluation/methods/response/transport.h"

namespace framelet {

void respond(DensityField& density, std::span<std::uint32_t const> elements, std::span<RateError const> errors,
             ResponseParameters const& parameters, ResponseScratch& scratch) {
    FRAMELET_CHECK(elements.size() == errors.size() && parameters.rate_unit > 0);
    double const unit = parameters.rate_unit;
    DensityBounds bounds = parameters.bounds;
    bounds.least.time /= unit;
    bounds.most.time /= unit;
    auto const at = [&](std::size_t i) {
        return Density{density.space[elements[i]], density.time[elements[i]] / unit};
    };
    std::size_t const count = elements.size();
    scratch.directions.resize(count);
    scratch.changes.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        LocalResponse const local = respond_locally(at(i), errors[i], bounds, parameters.gain);
        scratch.directions[i] = local.direction;
        scratch.changes[i] = local.change;
    }
    transport(scratch.changes);
    for (std::size_t i = 0; i < count; ++i) {
        Density to = mix(at(i), scratch.directions[i], scratch.changes[i], bounds);
        if (parameters.bias != 0) {
            to = slide(to, parameters.bias * std::hypot(errors[i].space, errors[i].time), bounds);
        }
        density.space[elements[i]] = to.space;
        // Rounding may have carried the value beyond a bound.
        density.time[elements[i]] =
            std::clamp(to.time * unit, parameters.bounds.least.time, parameters.bounds.most.time);
    }
}

} // namespace framelet
