// What is rendered when nothing is due: finer samples of what the viewer holds. In: the field, since when nothing has
// moved, samples. Out: patches.
#pragma once

#include <utility>
#include <vector>

#include "server/sampling/field/region_field.h"

namespace framelet {

/// The viewer holds the finest samples of a picture that stands since `still_since`, as far as is learnt.
bool is_finest(Region const& region, double still_since);
/// They are enough, or it got them with four rays each as well.
bool is_finished(Region const& region, double still_since);

/// Error and index of regions: scratch.
using UnresolvedRegions = std::vector<std::pair<float, std::uint32_t>>;

/// All of these append to `patches` until their samples are used.
/// Of a moment that is not to be seen for long: a level finer where that shows most for its samples, but not what is
/// among `patches` already.
void select_refinement(RegionField const& field, double samples, UnresolvedRegions& scratch,
                       std::vector<Patch>& patches);
/// What stands still is finished in the end, whatever the model says of it.
void select_completion(RegionField const& field, double still_since, bool scene_moves, double samples,
                       std::vector<Patch>& patches);
/// Where the finest samples of a still picture are not enough they are rendered once more, each with four rays: where
/// most is left unresolved first. `samples`: of one ray.
void select_supersampling(RegionField const& field, double still_since, double samples, UnresolvedRegions& scratch,
                          std::vector<Patch>& patches);

} // namespace framelet
