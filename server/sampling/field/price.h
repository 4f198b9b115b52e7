// The price of a sample: what the cheapest error that is still worth removing costs. In: the field, how many samples a
// second there are. Out: for every region how finely and how often it should be sampled, so that all together use what
// there is. This conserves the budget: the integral of density over space and time.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "server/render/rays_per_sample.h"
#include "server/sampling/field/region_field.h"

namespace framelet {

/// What the response may use. The evaluation narrows it, to see what each part is worth.
struct ResponseLimits {
    int least_level = 0, most_level = sampling_levels - 1; ///< of what is chosen for a region
    float least_price = 1e-12f, most_price = 1e3f;
    double periodic_share = 0.05; ///< of the samples, for looking at all of the picture now and then
    double probe_share = 0.08; ///< likewise, while the scene moves, for looking at a few samples of what seems to stand
    // Of moments, for a viewer that moves what it holds:
    bool mirrors = true; ///< what the viewer shows says what is rendered; else what the regions were last
    double visibility_share = 0.02; ///< of the samples, for rays that are not shaded
    bool expects_change = true; ///< of what turns, of outlines and of reflections
    bool plans_together = true; ///< the samples of several cycles; else of each on its own
    bool coarse_first = true; ///< where much is stale
    int most_rays = four_rays; ///< of a sample
};

struct Budget {
    double samples_per_second = 0;
    float cycle_seconds = 0.01f;
    float latency = 0; ///< seconds from rendering to display
    float bias = 0; ///< -1 (spatial fidelity) .. 1 (temporal)
    ResponseLimits limits{};
    /// What a sample costs of `samples_per_second`, by region and level; empty: one.
    std::span<LevelCosts const> costs{};
    /// From when on what was rendered is of the moment that is rendered now: once more it would be the very same.
    /// Infinite: each rendering is of a moment of its own.
    double moment_begun = std::numeric_limits<double>::infinity();
    bool still = false; ///< nothing moves: what is rendered now stays true, whatever was learnt of the region's motion
};

/// What a sample costs at the region.
inline LevelCosts const& costs_at(Budget const& budget, std::uint32_t index) {
    return budget.costs.empty() ? equal_costs : budget.costs[index];
}

/// For every region of a field, by Morton index; what is not visible keeps its default.
using Choices = std::vector<SamplingChoice>;

/// Finds the price at which the choices use the budget, from the last cycle's price, and the choices. Returns the
/// price. What is due already counts as if it were to be done within a few cycles, so that a cut makes samples dear,
/// and the first picture coarse. While nothing moves the price only falls, so that a tiling only gets finer.
/// `due`: what `find_due_errors` gives.
float solve_price(RegionField const& field, double now, Budget const& budget, std::span<float const> due,
                  float last_price, Choices& choices);

/// Samples a second that the choices ask for, by what they cost.
struct Demand {
    double pressing = 0; ///< for what moves, or is no longer true
    double refining = 0; ///< for what is true and coarse: it can wait and makes nothing dearer
};
Demand demand_of(RegionField const& field, Budget const& budget, std::span<float const> due, Choices const& choices);

/// Drift of a region while what is rendered of it is on its way.
float drift_on_the_way(Region const& region, Budget const& budget);

/// For every visible region, by Morton index, the error that it shows by the time at which a refresh would come.
void find_due_errors(RegionField const& field, Budget const& budget, std::vector<float>& due);

} // namespace framelet
