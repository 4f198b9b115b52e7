#include "tests/evaluation/methods/margin.h"

#include <algorithm>
#include <cmath>

#include "common/framelet/tile.h"

namespace framelet::bench {

int margin_pixels(double margin, int side) {
    constexpr int block = framelet_side;
    return margin > 0 ? std::max(1, static_cast<int>(std::lround(margin * side / block))) * block : 0;
}

Viewport with_margin(Viewport viewport, int margin_x, int margin_y) {
    return {viewport.width + 2 * margin_x, viewport.height + 2 * margin_y};
}

Camera with_margin(Camera camera, Viewport viewport, int margin_y) {
    if (margin_y > 0) {
        float const larger = static_cast<float>(viewport.height + 2 * margin_y) / static_cast<float>(viewport.height);
        camera.vertical_extent = camera.projection == Projection::perspective
                                     ? 2 * std::atan(larger * std::tan(0.5f * camera.vertical_extent))
                                     : larger * camera.vertical_extent;
    }
    return camera;
}

} // namespace framelet::bench
