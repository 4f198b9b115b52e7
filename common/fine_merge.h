// Neighbouring framelets as one where they show one plane: each one's rim costs what its middle costs when they move,
// and those finer than pixels are hardly more than rim. In: the cache, the tile that they are below. Out: their samples
// and the plane.
#pragma once

#include "common/framelet_warp.h"

namespace framelet {

/// Where all tiles of that depth below `over` are held, of one view, each with a single layer on the same body, and
/// those layers' inverse depths are within `tolerance` of one plane's, which is the least-squares fit to their middles.
/// False, with `merged` in any state, where that is not so. `depth` is 1, 2 or 3 more than that of `over`; `tolerance`
/// is not negative.
bool merge_fine(FrameletCache const& cache, Tile over, int depth, double tolerance, MergedFramelet& merged);

} // namespace framelet
