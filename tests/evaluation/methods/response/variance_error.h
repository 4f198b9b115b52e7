// Error estimate by variance ([Stephens 2011] section 5.2), the cheap alternative to the Haar transform. In: the
// samples of a framelet and those of the previous one of the same place. Out: sample-rate errors by block, and the
// samples to keep.
#pragma once

#include "tests/evaluation/methods/response/rate_error.h"

namespace framelet {

/// Samples of the previous framelet of a place.
using VarianceHistory = ErrorHistory;

/// Templates of `estimate_variance`, fitted to errors of rendered pictures.
inline constexpr RateTemplates variance_templates{{-11.25f, 0.0f}, {-11.0f, -4.125f}};

/// Error of each block, called as `estimate_haar` is: in space from the variance of its samples ([Stephens 2011]
/// eq. 5.5), in time from the mean square of what they differ from the previous ones; 0 without a history. Each is
/// compared with its template, (energy - template) / (energy + template). Variance knows no octaves: of the template in
/// space only the offset counts; the one in time is a line over the interval. The variance of a single sample is taken
/// over the 2x2 samples that it lies in.
void estimate_variance(std::span<float const> samples, VarianceHistory& history, float seconds_since,
                       RateTemplates const& templates, std::span<RateError> elements);

} // namespace framelet
