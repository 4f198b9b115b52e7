// Depth-first order of tiles of mixed depth ([Stephens 2011] section 4.1.4): every subtree is one interval, so that
// tiles which overlap a coarse one lie side by side. In: a tile; out: its number in a complete binary tree walked depth
// first.
#pragma once

#include <cstdint>

#include "common/framelet/tile.h"

namespace framelet {

/// Nodes of the complete binary subtree under node `index` (a kd-tree index as tile codes are: the root is 1, the
/// children of k are 2k and 2k + 1) in a tree whose deepest nodes have kd depth `max_depth`: [Stephens 2011] eq. 4.12,
/// 2^(max_depth - floor(log2 index) + 1) - 1.
std::uint64_t subtree_size(std::uint32_t index, int max_depth);

/// 1-based number of the node ([Stephens 2011] eq. 4.13): D(1) = 1, D(k) = 1 + D(k / 2), and for odd k the size of the
/// sibling's subtree more.
std::uint64_t depth_first_index(std::uint32_t index, int max_depth);

/// The same for a tile, in a quadtree whose deepest tiles have depth `max_tile_depth` (kd depth 2 * max_tile_depth).
inline std::uint64_t depth_first_index(Tile tile, int max_tile_depth) {
    return depth_first_index(tile.code, 2 * max_tile_depth);
}

} // namespace framelet
