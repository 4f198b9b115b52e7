// Fills holes, the pixels that no sample shows, from what lies around them, from the farther side (pull-push,
// [Gortler 1996]; [Scherzer 2012] section 3.3). In: picture, inverse depth with holes, means of blocks. Out: the holes'
// pixels. Blocks are independent of each other once their means and cells are there, and equal what the whole picture
// would give.
#pragma once

#include <span>

#include "common/image.h"
#include "common/picture/far_grid.h"
#include "common/picture/far_means.h"

namespace framelet {

/// The mean of the farthest in each 2x2 (`level1`), 4x4 and 8x8 pixels of a block, from which the holes beside it are
/// filled.
struct FarCells {
    FarGrid<8> level1;
    FarGrid<4> level2;
    FarGrid<2> level3;
};

/// The cells of one block of a picture, of which holes are those pixels whose `inverse_depth` (a plane of its size) is
/// `hole_depth`.
FarCells far_cells(std::span<float const> inverse_depth, Picture const& picture, int column, int row);

/// Fills the holes among a block's pixels. `cells` are the blocks', in rows; only those of this block and of the eight
/// around it need be there. Where nothing shows anywhere holes become `uncovered_light`.
void fill_holes(FarMeans const& means, std::span<FarCells const> cells, std::span<float const> inverse_depth,
                int column, int row, Picture& picture);

} // namespace framelet
