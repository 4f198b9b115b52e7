#include "server/schedule/refinement.h"

#include <algorithm>

#include "common/error.h"

namespace framelet {

Refinement start_refinement(ImagePlane const& plane, int depth) {
    return {make_uniform_tiling(plane, depth), depth, 0};
}

std::vector<Tile> select_tiles(Refinement& refinement, std::size_t limit) {
    FRAMELET_CHECK(limit >= 1);
    if (is_converged(refinement)) {
        return {};
    }
    if (refinement.next == refinement.tiling.tiles.size()) {
        refinement = start_refinement(refinement.tiling.plane, refinement.depth + 1);
    }
    auto const first = refinement.tiling.tiles.begin() + static_cast<std::ptrdiff_t>(refinement.next);
    std::size_t const count = std::min(limit, refinement.tiling.tiles.size() - refinement.next);
    refinement.next += count;
    return {first, first + static_cast<std::ptrdiff_t>(count)};
}

bool is_converged(Refinement const& refinement) {
    return refinement.next == refinement.tiling.tiles.size() && refinement.depth == refinement.tiling.plane.max_depth();
}

} // namespace framelet
