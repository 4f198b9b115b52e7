// A margin around the viewport: a larger viewport whose pixels are as large and lie at the same positions.
#pragma once

#include "common/camera.h"
#include "common/image.h"

namespace framelet::bench {

/// Pixels of a margin on each side; `margin`: its share of the picture's side. Whole blocks, at least one unless
/// `margin` is 0 or less.
int margin_pixels(double margin, int side);
Viewport with_margin(Viewport viewport, int margin_x, int margin_y);
/// The camera that shows the same at the same size, with the margin around it. `viewport`: that without the margin.
Camera with_margin(Camera camera, Viewport viewport, int margin_y);

inline double pixel_count(Viewport viewport) {
    return static_cast<double>(viewport.width) * viewport.height;
}
inline double pixel_count(Picture const& picture) {
    return pixel_count(Viewport{picture.width, picture.height});
}

} // namespace framelet::bench
