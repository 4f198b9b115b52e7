// Finds the best way to sample a region for a given price of samples. In: what is known of the region, the price, the
// latency until it shows. Out: how finely, how often, and what error that leaves.
//
// A region that is refreshed at level l every P seconds shows on average the error
//     F = unresolved(l) + mean over ages a in [latency, latency + P] of drift_error(l, motion a),
// and costs samples_per_pixel(l) / P (times what a sample costs). The choice minimises F + price * cost. With
// drift_error taken as one exponential, V (1 - exp(-r a)), the best period solves 1 - exp(-x)(1 + x) = price * spp * r
// / (V exp(-r latency)) for x = r P, and what is paid altogether is unresolved(l) + V (1 - exp(-r latency - x)): the
// error at the end of the period.
#pragma once

#include <cmath>

#include "server/sampling/model/coding_cost.h"

namespace framelet {

/// Costs of samples that all cost the same.
inline constexpr LevelCosts equal_costs = [] {
    LevelCosts costs{};
    costs.fill(1);
    return costs;
}();

struct SamplingPrice {
    float price = 0; ///< of one sample a pixel a second, in mean squared error
    float latency = 0; ///< seconds from rendering to display
    float least_period = 0; ///< seconds; a cycle
    float bias = 0; ///< -1 (spatial fidelity) .. 1 (temporal)
};

/// What errors count as the viewer wishes: those of what has passed, those of what is missing between samples. `bias`:
/// as of `SamplingPrice`; 4 to its power, and the inverse.
struct BiasWeights {
    explicit BiasWeights(float bias) : time(bias == 0 ? 1 : std::exp2(2 * bias)), space(1 / time) {}

    float time, space;
};

struct SamplingChoice {
    int level = 0;
    float period = 0; ///< seconds between refreshes
    float due_error = 0; ///< it is time to refresh once the shown error is as great
    bool recurring = false; ///< false: it goes on as it is for its life; another refresh is not worth its price
};

/// Chooses level and period. `life`: seconds for which the region is expected to go on as it does: nothing is worth
/// more than it saves in that time. `least_level`, `most_level`: levels to choose from. `costs`: what a sample of each
/// level costs, in the samples that `price` is of.
SamplingChoice choose_sampling(RegionModel const& region, float life, SamplingPrice const& price, int least_level,
                               int most_level, LevelCosts const& costs);

} // namespace framelet
