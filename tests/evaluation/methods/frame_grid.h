// A whole frame of samples at one spacing, and the mean of several such frames, sampled at different positions in the
// samples' cells. In: a posed scene, a camera. Out: framelets as rendered and as displayed, and the picture of one
// pixel a sample.
#pragma once

#include <vector>

#include "common/image.h"
#include "server/render/framelet_renderer.h"

namespace framelet::bench {

class FrameGrid {
public:
    /// `spacing`: pixels from sample to sample: 1, 2 or 4.
    FrameGrid(Viewport viewport, int spacing);

    /// Begins anew: renders every sample at the middle of its cell. Returns the number of rays traced.
    std::uint64_t render(RenderScene const& scene, Camera const& camera, float exposure);
    /// Renders one more such frame of the same, at the next of `offsets` positions in the cells, and adds it to the
    /// mean, which is taken of light as displayed. Returns the number of rays traced.
    std::uint64_t add(RenderScene const& scene, Camera const& camera, float exposure);

    /// Number of positions in a cell: after so many frames the mean is taken for the truth. With 16 some of the
    /// project's scenes stay below 38 dB.
    static constexpr int offsets = 64;

    int spacing() const { return spacing_; }
    int frames() const { return frames_; } ///< number of frames in the mean
    std::size_t samples() const { return tiles_.size() * framelet_samples; } ///< number of samples in one frame
    ImagePlane const& plane() const { return plane_; }
    /// The first frame as rendered: before exposure, with depths and bodies.
    std::vector<Framelet> const& rendered() const { return rendered_; }
    /// The mean as displayed. Before anything was rendered only the tiles are set.
    std::vector<DisplayFramelet> const& framelets() const { return displayed_; }
    /// The mean as a picture of one pixel a sample.
    Picture const& picture();

private:
    using Light = std::array<std::array<float, framelet_samples>, 3>;

    std::uint64_t render_at(RenderScene const& scene, Camera const& camera, Vec2 offset, std::span<Framelet> out) const;
    void show(std::vector<Framelet> const& newest, float exposure);

    ImagePlane plane_;
    int spacing_;
    std::vector<Tile> tiles_;
    std::vector<Framelet> rendered_, fresh_;
    std::vector<Light> sums_;
    std::vector<DisplayFramelet> displayed_;
    Picture picture_;
    int frames_ = 0;
};

/// Enlarges a picture of one pixel a sample, samples `spacing` pixels apart, to full size: bilinear, in linear light.
void upsample(Picture const& samples, int spacing, Picture& out);

/// `write_samples` writes the framelet's samples to a picture of one pixel a sample, `take_samples` reads them from
/// there. Beyond the picture's border nothing is written, and its last pixels are read repeatedly.
void write_samples(DisplayFramelet const& framelet, Picture& picture);
void take_samples(Picture const& picture, DisplayFramelet& framelet);

} // namespace framelet::bench
