#include "tests/evaluation/methods/margin_viewer.h"

#include <algorithm>

#include "tests/evaluation/methods/margin.h"

namespace framelet::bench {

MarginViewer::MarginViewer(MethodSetup const& setup)
    : viewport_(setup.viewport), margin_x_(margin_pixels(setup.rivals.margin, viewport_.width)),
      margin_y_(margin_pixels(setup.rivals.margin, viewport_.height)),
      wide_(with_margin(viewport_, margin_x_, margin_y_), setup.costs), picture_(viewport_.width, viewport_.height) {}

ViewerStep MarginViewer::present(Camera const& camera, SceneTime time) {
    ViewerStep step = wide_.present(with_margin(camera, viewport_, margin_y_), time);
    Picture const& wide = wide_.picture();
    for (int y = 0; y < picture_.height; ++y) {
        std::copy_n(wide.row(y + margin_y_) + 4 * static_cast<std::ptrdiff_t>(margin_x_),
                    4 * static_cast<std::ptrdiff_t>(picture_.width), picture_.row(y));
    }
    step.seconds.reconstruct *= pixel_count(picture_) / pixel_count(wide);
    return step;
}

} // namespace framelet::bench
