// A viewer that holds more than it shows: a margin around the viewport, which a turn of the camera brings into view
// before any message knows of it. In: batches of the larger viewport. Out: the picture of the viewport.
#pragma once

#include "tests/evaluation/methods/warp_viewer.h"

namespace framelet::bench {

class MarginViewer {
public:
    /// The margin is that of `setup.rivals`.
    explicit MarginViewer(MethodSetup const& setup);

    ViewerStep insert(Batch const& batch) { return wide_.insert(batch); }
    /// Charged is what is shown: a viewer need not paint the margin.
    ViewerStep present(Camera const& camera, SceneTime time);

    Picture const& picture() const { return picture_; }

private:
    Viewport const viewport_;
    int const margin_x_, margin_y_;
    WarpViewer wide_;
    Picture picture_;
};

} // namespace framelet::bench
