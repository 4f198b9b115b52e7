// Judges how well an error estimator agrees with the oracle, over many places and sample rates.
#pragma once

#include <span>
#include <vector>

#include "tests/evaluation/estimators/observations.h"
#include "tests/evaluation/methods/response/error_estimators.h"

namespace framelet::bench {

/// One axis of one place at one sample rate.
struct Verdict {
    double estimate = 0; ///< the error, [-1, 1]
    double truth = 0; ///< log2(ideal rate / rate), rates being those along the axis: > 0 undersampled
    int rate = 0; ///< level or interval (observations.h)
};

struct Verdicts {
    std::vector<Verdict> space, time; ///< place by place, level by level, interval by interval
};

/// The estimator's last word at each place, level and interval, after `observed_refreshes` framelets.
Verdicts judge(ErrorEstimator const& estimator, RateTemplates const& templates, std::span<Place const> places);

/// Octaves from the ideal rate within which a rate is right: the sign that is estimated there does not count.
inline constexpr double close_to_ideal = 0.25;

/// Shares of the verdicts whose sign is right.
struct SignAgreement {
    double all = 0;
    double balanced = 0; ///< mean of the share among the undersampled and that among the redundant
};
SignAgreement sign_agreement(std::span<Verdict const> verdicts);

struct Agreement {
    double rank = 0; ///< Spearman's rank correlation of estimate and truth, over everything
    double rank_at_rate = 0; ///< mean of that correlation within each rate: does it tell places apart?
    SignAgreement signs;
};
Agreement agreement(std::span<Verdict const> verdicts);

/// Agreement of the best answer that knows the rate but not the samples: one ideal for all places.
enum class RateOrder { ascending, descending }; ///< levels get denser, intervals rarer
Agreement agreement_of_rate_alone(std::span<Verdict const> verdicts, RateOrder order);

/// Rank correlation of [Spearman 1904]; equal values share their mean rank. 0 where one of them is constant.
double rank_correlation(std::span<double const> a, std::span<double const> b);

} // namespace framelet::bench
