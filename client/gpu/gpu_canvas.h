// Paints moved pictures on the graphics card (OpenGL 3.3 core): one shader runs over the patches of each block with the
// arithmetic of `paint_warped_block`, others fill holes and filter outlines. In: jobs. Out: a texture, what showed.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "common/image.h"
#include "common/picture/block_canvas.h"

namespace framelet {

/// Needs one OpenGL 3.3 context to be current in all calls, at destruction too; it leaves no framebuffer, program or
/// buffer bound, and blending, depth and scissor tests off.
class GpuCanvas final : public BlockCanvas {
public:
    /// Throws CanvasError where the driver refuses the shaders, or has not what they need.
    GpuCanvas();
    ~GpuCanvas() override;

    bool begin(void const* owner, bool is_new, Viewport viewport) override;
    void paint(CanvasJobs const& jobs, std::vector<BlockReport>& reports) override;

    /// The texture of the picture, rows from the top; 0 before there is one. It stays as it is when pictures get
    /// another size, until one of that size has been asked for and they get yet another.
    std::uint32_t texture();
    Viewport size() const;
    /// Copies the picture to the framebuffer of the context, which has its size, as a web page shows it.
    void show() const;
    /// Copies the picture to memory; waits for the card. `picture` gets its size.
    void read(Picture& picture) const;
    /// Inverse depths of what was painted last, 1 / metres, `hole_depth` in holes; for tests.
    void read_inverse_depths(std::vector<float>& out) const;

    /// Objects of OpenGL that it has made since it began.
    std::size_t made_objects() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace framelet
