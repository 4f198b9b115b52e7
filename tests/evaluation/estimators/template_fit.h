// Fits an estimator's templates to the oracle.
#pragma once

#include "tests/evaluation/estimators/agreement.h"

namespace framelet::bench {

/// The templates with the greatest balanced `sign_agreement` in space and in time. Searched from a grid over offsets of
/// -22 to -2 and slopes of -2.5 to 3.5 (log2 of energy, per octave), then on ever finer ones about the best so far,
/// which may leave the first; of equals, the one with the smaller slope.
RateTemplates fit_templates(ErrorEstimator const& estimator, std::span<Place const> places);

} // namespace framelet::bench
