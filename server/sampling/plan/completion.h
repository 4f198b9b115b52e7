// Completes a picture that stands: the finest samples everywhere, whatever a plan makes of them, then means of more
// rays where those leave too much. In: regions, since when nothing has moved, samples. Out: patches.
#pragma once

#include <span>
#include <vector>

#include "common/framelet/framelet.h"
#include "server/sampling/held/region_grid.h"

namespace framelet {

/// What a picture is complete with. With direct light, what one ray leaves is judged by how much samples differ.
struct Completion {
    int finest = finest_level; ///< level of its samples
    int most_rays = four_rays; ///< of each sample
    float enough = 5e-5f; ///< mean squared error that may be left (`Region::left`)
};
/// That of light by paths: a sample a pixel, through all of which its paths go. The standard error that may be left is
/// half a step of a display's bytes.
inline constexpr Completion completion_of_paths{pixel_level, 1024, 1.0f / (512 * 512)};

/// True where the viewer holds the finest samples of the region, of a picture that stands since `still_since`
/// (seconds), as far as is learnt, and these are enough, or are means of as many rays as may be.
bool is_finished(Region const& region, double still_since, Completion const& completion);

/// Mean squared error that samples of the finest level leave of these framelets of it, by the luma of those: what is
/// finer has about as much energy as what they resolve last, and a pixel shows the mean of all.
float error_left(std::span<DisplayFramelet const> framelets);

/// Selects the finest samples of what has none of this picture, along the Morton curve, until `samples` are used.
void select_finest(RegionGrid const& regions, double still_since, Completion const& completion, double samples,
                   std::vector<Patch>& patches);
/// Selects regions of which the finest samples are not enough, to have more rays a sample: those that have the fewest,
/// and of these those where most is left first. `samples`: of one ray. Returns how many rays a sample they are to have.
int select_supersampling(RegionGrid const& regions, double still_since, Completion const& completion, double samples,
                         std::vector<Patch>& patches);

} // namespace framelet
