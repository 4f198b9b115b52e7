// Finds the price of a sample: the Lagrange multiplier of the sample budget, that is the squared error that a sample
// has to take away to be worth rendering. In: the field, how many samples a second there are. Out: for every region how
// finely and how often it should be sampled, so that all together use what there is. This conserves the budget: the
// integral of density over space and time.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "server/render/rays_per_sample.h"
#include "server/sampling/field/region_field.h"
#include "server/sampling/model/sampling_choice.h"

namespace framelet {

/// The bounds of what may be chosen and used. The evaluation narrows them, to see what each part is worth.
struct ResponseLimits {
    int least_level = 0, most_level = sampling_levels - 1; ///< levels that may be chosen for a region
    float least_price = 1e-12f, most_price = 1e3f; ///< as `SamplingPrice::price`
    double periodic_share = 0.05; ///< share of the samples for periodic refreshes, which look at all of the picture
    double probe_share = 0.08; ///< share of the samples for probes of what seems to stand, while the scene moves
    // The following apply to moments, for a viewer that moves its samples:
    bool mirrors = true; ///< the mirror says what is worth rendering; else the region field does
    double visibility_share = 0.02; ///< share of the samples for visibility rays, which are not shaded
    bool expects_change = true; ///< decorrelation is expected of what turns, of outlines and of reflections
    bool plans_together = true; ///< the samples of several cycles are planned together; else each cycle on its own
    bool coarse_first = true; ///< where much is stale, all of it is rendered coarsely first
    int most_rays = four_rays; ///< most rays of a sample
};

struct Budget {
    double samples_per_second = 0;
    float cycle_seconds = 0.01f;
    float latency = 0; ///< seconds from rendering to display
    float bias = 0; ///< -1 (spatial fidelity) .. 1 (temporal)
    ResponseLimits limits{};
    /// Cost of a sample in `samples_per_second`, by region and level; empty: 1.
    std::span<LevelCosts const> costs{};
    /// Time, seconds, since which all that was rendered is of the moment that is rendered now: once more it would be
    /// the very same. Infinite: each rendering is of a moment of its own.
    double moment_begun = std::numeric_limits<double>::infinity();
    bool still = false; ///< nothing moves: what is rendered now stays true, whatever was learnt of the region's motion
};

/// Cost of a sample of each level at a region.
inline LevelCosts const& costs_at(Budget const& budget, std::uint32_t index) {
    return budget.costs.empty() ? equal_costs : budget.costs[index];
}

/// One choice for every region of a field, by Morton index; regions that are not visible keep the default.
using Choices = std::vector<SamplingChoice>;

/// Finds the price at which the choices use the budget, from the last cycle's price, and the choices. Returns the
/// price. What is due already counts as if it were to be done within a few cycles, so that a cut makes samples dear,
/// and the first picture coarse. While nothing moves the price only falls, so that a tiling only gets finer.
/// `due`: what `find_due_errors` gives.
float solve_price(RegionField const& field, double now, Budget const& budget, std::span<float const> due,
                  float last_price, Choices& choices);

/// Samples a second that the choices ask for, counted by what they cost.
struct Demand {
    double pressing = 0; ///< for what moves, or is no longer true
    double refining = 0; ///< for what is true and coarse: it can wait and makes nothing dearer
};
Demand demand_of(RegionField const& field, Budget const& budget, std::span<float const> due, Choices const& choices);

/// Drift of a region while what is rendered of it is on its way.
float drift_on_the_way(Region const& region, Budget const& budget);

/// Sets `due`, by Morton index, to the error that every visible region will show by the time at which a refresh would
/// come.
void find_due_errors(RegionField const& field, Budget const& budget, std::vector<float>& due);

} // namespace framelet
