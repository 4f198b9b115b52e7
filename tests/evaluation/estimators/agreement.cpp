#include "tests/evaluation/estimators/agreement.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <tbb/parallel_for.h>

#include "common/error.h"

namespace framelet::bench {
namespace {

// Lower bounds of the ideal rates, half the lowest rates observed: a place that needs less is taken to need as little
// as that.
constexpr double least_samples_per_pixel_side = 1.0 / 16;
constexpr double least_refreshes_per_second = oracle_rate / (2 << (observed_intervals - 1));

/// Error of the place, estimated from the last of the framelets that `level` has there.
RateError error_at(ErrorEstimator const& estimator, RateTemplates const& templates, Place const& place, int level,
                   int interval) {
    int const coarser = std::max(coarsest_levels - level, 0);
    std::vector<RateError> elements(std::size_t(1) << (2 * coarser));
    RateError sum;
    for (int index = 0; index < framelets_at(level); ++index) {
        ErrorHistory history;
        for (int refresh = observed_refreshes - 1; refresh >= 0; --refresh) {
            estimator.estimate(observed_samples(place, refresh << interval, level, index), history,
                               static_cast<float>(seconds_at(interval)), templates, elements);
        }
        RateError const& error = elements[place.tile.code % elements.size()];
        sum.space += error.space;
        sum.time += error.time;
    }
    auto const count = static_cast<float>(framelets_at(level));
    return {sum.space / count, sum.time / count};
}

std::vector<double> ranks(std::span<double const> values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
    std::vector<double> result(values.size());
    for (std::size_t first = 0, last = 0; first < order.size(); first = last) {
        while (last < order.size() && values[order[last]] == values[order[first]]) {
            ++last;
        }
        for (std::size_t i = first; i < last; ++i) {
            result[order[i]] = static_cast<double>(first + last - 1) / 2;
        }
    }
    return result;
}

double rank_of(std::span<Verdict const> verdicts) {
    std::vector<double> estimates, truths;
    for (Verdict const& verdict : verdicts) {
        estimates.push_back(verdict.estimate);
        truths.push_back(verdict.truth);
    }
    return rank_correlation(estimates, truths);
}

std::map<int, std::vector<Verdict>> by_rate(std::span<Verdict const> verdicts) {
    std::map<int, std::vector<Verdict>> result;
    for (Verdict const& verdict : verdicts) {
        result[verdict.rate].push_back(verdict);
    }
    return result;
}

} // namespace

Verdicts judge(ErrorEstimator const& estimator, RateTemplates const& templates, std::span<Place const> places) {
    constexpr std::size_t rates = std::size_t(observed_levels) * observed_intervals;
    Verdicts verdicts{std::vector<Verdict>(places.size() * rates), std::vector<Verdict>(places.size() * rates)};
    tbb::parallel_for(std::size_t(0), places.size(), [&](std::size_t p) {
        Place const& place = places[p];
        double const per_side = std::max(2 * place.ideal.space_frequency, least_samples_per_pixel_side);
        double const per_second = std::max(place.ideal.refreshes_per_second(), least_refreshes_per_second);
        std::size_t next = p * rates;
        for (int level = 0; level < observed_levels; ++level) {
            for (int interval = 0; interval < observed_intervals; ++interval, ++next) {
                RateError const error = error_at(estimator, templates, place, level, interval);
                verdicts.space[next] = {error.space, std::log2(per_side * spacing_at(level)), level};
                verdicts.time[next] = {error.time, std::log2(per_second * seconds_at(interval)), interval};
            }
        }
    });
    return verdicts;
}

SignAgreement sign_agreement(std::span<Verdict const> verdicts) {
    double right[2] = {}, all[2] = {}; // by kind: redundant, undersampled
    for (Verdict const& verdict : verdicts) {
        if (std::abs(verdict.truth) >= close_to_ideal) {
            bool const under = verdict.truth > 0;
            all[under] += 1;
            right[under] += (under ? verdict.estimate > 0 : verdict.estimate < 0) ? 1 : 0;
        }
    }
    return {(right[0] + right[1]) / std::max(all[0] + all[1], 1.0),
            (right[0] / std::max(all[0], 1.0) + right[1] / std::max(all[1], 1.0)) / 2};
}

Agreement agreement(std::span<Verdict const> verdicts) {
    Agreement result;
    result.rank = rank_of(verdicts);
    auto const groups = by_rate(verdicts);
    for (auto const& [rate, group] : groups) {
        result.rank_at_rate += rank_of(group) / static_cast<double>(groups.size());
    }
    result.signs = sign_agreement(verdicts);
    return result;
}

Agreement agreement_of_rate_alone(std::span<Verdict const> verdicts, RateOrder order) {
    double const sign = order == RateOrder::ascending ? -1 : 1;
    std::vector<Verdict> answers(verdicts.begin(), verdicts.end()), best;
    double score = -1;
    for (int first = 0; first <= by_rate(verdicts).rbegin()->first + 1; ++first) {
        for (std::size_t i = 0; i < answers.size(); ++i) {
            answers[i].estimate = sign * (verdicts[i].rate - first + 0.5);
        }
        if (double const found = sign_agreement(answers).balanced; found > score) {
            score = found;
            best = answers;
        }
    }
    return agreement(best);
}

double rank_correlation(std::span<double const> a, std::span<double const> b) {
    FRAMELET_CHECK(a.size() == b.size());
    if (a.empty()) {
        return 0;
    }
    std::vector<double> const x = ranks(a), y = ranks(b);
    double const mean = static_cast<double>(a.size() - 1) / 2;
    double xx = 0, yy = 0, xy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx += (x[i] - mean) * (x[i] - mean);
        yy += (y[i] - mean) * (y[i] - mean);
        xy += (x[i] - mean) * (y[i] - mean);
    }
    return xx > 0 && yy > 0 ? xy / std::sqrt(xx * yy) : 0;
}

} // namespace framelet::bench
