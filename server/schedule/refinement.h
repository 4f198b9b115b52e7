// The order in which one view is refreshed: uniform tilings from coarse to fine, every tile in turn. Starts anew when
// what is seen changes. In: plane, depth, how many tiles fit; out: the tiles of the next batch.
#pragma once

#include "server/schedule/tiling.h"

namespace framelet {

/// How far the refresh of one unchanged view has come.
struct Refinement {
    Tiling tiling; ///< of the depth being refreshed
    int depth = 0;
    std::size_t next = 0; ///< into tiling.tiles
};

/// Begins with the uniform tiling of this depth.
Refinement start_refinement(ImagePlane const& plane, int depth);

/// The next tiles in turn, at most `limit` (>= 1), all of one depth. A tiling that is done is followed by the one a
/// level finer; after the finest there is nothing left to do and the answer is empty.
std::vector<Tile> select_tiles(Refinement& refinement, std::size_t limit);

/// True when select_tiles would return nothing.
bool is_converged(Refinement const& refinement);

} // namespace framelet
