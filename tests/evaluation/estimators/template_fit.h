// Fits an estimator's templates to the oracle.
#pragma once

#include "tests/evaluation/estimators/agreement.h"

namespace framelet::bench {

/// The templates with the greatest balanced `sign_agreement` in space and in time. Searched on a grid over offsets of
/// -22 to -2 and slopes of -3 to 4 (log2 of energy, per octave), then on ever finer ones about the best; of equals, the
/// one with the smaller slope.
RateTemplates fit_templates(ErrorEstimator const& estimator, std::span<Place const> places);

} // namespace framelet::bench
