// Fills holes on the graphics card as `fill_holes` does. In: colours and inverse depths of a picture, which blocks have
// holes. Out: the colours, filled.
#pragma once

#include <vector>

#include "client/gpu/gl/gl_objects.h"
#include "client/gpu/gl/render_pass.h"
#include "common/camera.h"

namespace framelet {

class FarPasses {
public:
    /// Throws CanvasError where the driver refuses its shaders.
    explicit FarPasses(GlCount& count);

    /// Makes room for pictures of this size. Throws CanvasError where there is none.
    void set_size(Viewport viewport);

    /// Draws over the pixels that are holes in `depths` (1 / metres; -1 in holes). `colors`: alpha does not count;
    /// `target` is that plane's. `figures`: a texel for each block, whose third number says how many holes it has.
    void fill(GlPlane const& colors, GlPlane const& depths, GlPlane const& figures, GlTarget const& target) const;

private:
    /// Cells of one size.
    struct Cells {
        Cells(int width, int height, GlCount& count);

        GlPlane plane;
        GlTarget target;
    };

    GlCount& count_;
    RenderPass pull_pixels_, pull_, block_mean_, pull_means_, push_means_, push_, fill_;
    Viewport viewport_{0, 0};
    std::vector<Cells> pulled_; ///< of 2, 4 and 8 pixels, each from finer ones
    std::vector<Cells> means_; ///< of blocks (16 pixels) and of ever larger squares of them, to a single one
    std::vector<Cells> pushed_means_; ///< the same but for the coarsest, with no cell left that is nothing
    std::vector<Cells> pushed_; ///< of 8, 4 and 2 pixels, filled from coarser ones, with a border of one cell
};

} // namespace framelet
