// Framelets finer than pixels, as one framelet of pixels where they show one plane: most of what they cost when they
// move is per framelet. In: the cache, the tile that they are below. Out: their pixels and the plane.
#pragma once

#include "common/framelet_warp.h"

namespace framelet {

/// Where all tiles of that depth below `over` are held, of one view, each with a single layer on the same body, and
/// those layers' inverse depths are within `tolerance` of one plane's, which is the least-squares fit to their middles.
/// False, with `merged` in any state, where that is not so. `depth` is 1 or 2 more than that of `over`; `tolerance` is
/// not negative.
bool merge_fine(FrameletCache const& cache, Tile over, int depth, double tolerance, MergedFramelet& merged);

} // namespace framelet
