// Selects the patches of a tiling that are rendered next: those by whose refresh the picture gains most for what they
// cost. In: the field, the choices, the cut that follows from them. Out: patches, the most urgent first.
#pragma once

#include <vector>

#include "server/render/rays_per_sample.h"
#include "server/sampling/field/price.h"

namespace framelet {

struct RatedPatch {
    Patch patch;
    double samples = 0; ///< rays that it takes
    double cost = 0; ///< what it costs of the budget, in samples
    double urgency = 0; ///< error that waiting costs, summed over pixels, a sample of its cost; above 0: it is due
    int rays_per_sample = single_ray;
};

/// Replaces `rated` by every patch of the cut, with its urgency; a patch that would put something coarser over what is
/// true gives way to those of its regions that need it. `due`: what `find_due_errors` gives.
void rate_patches(RegionField const& field, Choices const& choices, std::span<float const> due,
                  std::vector<Patch> const& cut, Budget const& budget, std::vector<RatedPatch>& rated);

/// Keeps what is due, the most urgent first, until `budget` is spent or there are `most_samples`.
void select_patches(double budget, double most_samples, std::vector<RatedPatch>& rated);

/// Appends a patch unless it is among the first `count` already: once is enough. Returns whether it was appended.
bool append_new(Patch const& patch, std::size_t count, std::vector<Patch>& patches);

/// Seconds that a region may go without a look at all of its pixels: at least two, and so many that looking takes
/// `periodic_share` of the samples. This bounds how long anything small can stay unseen.
double refresh_period(RegionField const& field, Budget const& budget);

/// Appends a patch at one sample a pixel for each region that has not been looked at for `refresh_period`, within
/// `periodic_share` of a cycle's samples, those that have waited longest first. `scratch` is overwritten.
void select_periodic_refreshes(RegionField const& field, double now, Budget const& budget,
                               std::vector<std::uint32_t>& scratch, std::vector<Patch>& patches);

} // namespace framelet
