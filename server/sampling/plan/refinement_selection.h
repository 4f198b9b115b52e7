// Selects what is rendered when nothing is due: finer samples of what the viewer holds. In: the field, since when
// nothing has moved, samples. Out: patches.
#pragma once

#include <utility>
#include <vector>

#include "server/sampling/field/region_field.h"

namespace framelet {

/// True where the viewer holds the finest samples of the region, of a picture that stands since `still_since`
/// (seconds), as far as is learnt, and these are enough, or are means of four rays.
bool is_finished(Region const& region, double still_since);

/// Error and index of regions: scratch.
using UnresolvedRegions = std::vector<std::pair<float, std::uint32_t>>;

/// Each of these functions appends to `patches` until its samples are used. This one is for a moment that is not to be
/// seen for long: it selects a level finer where that shows most for its samples, but not what is among `patches`
/// already.
void select_refinement(RegionField const& field, double samples, UnresolvedRegions& scratch,
                       std::vector<Patch>& patches);
/// Selects the finest samples of what stands still, which is finished in the end, whatever the model says of it.
void select_completion(RegionField const& field, double still_since, bool scene_moves, double samples,
                       std::vector<Patch>& patches);
/// Selects regions of a still picture of which the finest samples are not enough, to be rendered once more with four
/// rays a sample: those where most is left unresolved first. `samples`: of one ray.
void select_supersampling(RegionField const& field, double still_since, double samples, UnresolvedRegions& scratch,
                          std::vector<Patch>& patches);

} // namespace framelet
