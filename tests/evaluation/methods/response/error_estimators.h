// The error estimators to choose from, as values.
#pragma once

#include <array>

#include "tests/evaluation/methods/response/haar_error.h"
#include "tests/evaluation/methods/response/variance_error.h"

namespace framelet {

struct ErrorEstimator {
    char const* name;
    /// Estimates the errors of a framelet's blocks, called as `estimate_haar` is, with a history of this estimator's
    /// own.
    void (*estimate)(std::span<float const> samples, ErrorHistory& history, float seconds_since,
                     RateTemplates const& templates, std::span<RateError> elements);
    RateTemplates templates; ///< templates fitted to this estimator
};

inline constexpr std::array error_estimators{
    ErrorEstimator{"haar", estimate_haar, haar_templates},
    ErrorEstimator{"variance", estimate_variance, variance_templates},
};

} // namespace framelet
