// Completes a picture that stands: the finest samples everywhere, whatever a plan makes of them, then means of four
// rays where those leave too much. In: regions, since when nothing has moved, samples. Out: patches.
#pragma once

#include <span>
#include <vector>

#include "common/framelet/framelet.h"
#include "server/sampling/held/region_grid.h"

namespace framelet {

/// True where the viewer holds the finest samples of the region, of a picture that stands since `still_since`
/// (seconds), as far as is learnt, and these are enough, or are means of four rays.
bool is_finished(Region const& region, double still_since);

/// True where the finest samples leave little enough (`Region::left`).
bool is_enough(float left);

/// Mean squared error that samples of the finest level leave of these framelets of it, by the luma of those: what is
/// finer has about as much energy as what they resolve last, and a pixel shows the mean of all.
float error_left(std::span<DisplayFramelet const> framelets);

/// Selects the finest samples of what has none of this picture, along the Morton curve, until `samples` are used.
void select_finest(RegionGrid const& regions, double still_since, double samples, std::vector<Patch>& patches);
/// Selects regions of which the finest samples are not enough, to be rendered once more with four rays a sample: those
/// where most is left first. `samples`: of one ray.
void select_supersampling(RegionGrid const& regions, double still_since, double samples, std::vector<Patch>& patches);

} // namespace framelet
