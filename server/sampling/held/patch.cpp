#include "server/sampling/held/patch.h"

namespace framelet {

void append_tiles(ImagePlane const& plane, Patch const& patch, std::vector<Tile>& tiles) {
    int const shift = 2 * (patch.depth - patch.node.depth());
    std::uint32_t const first = patch.node.code << shift;
    for (std::uint32_t i = 0; i < (1u << shift); ++i) {
        if (plane.is_visible({first + i})) {
            tiles.push_back({first + i});
        }
    }
}

} // namespace framelet
