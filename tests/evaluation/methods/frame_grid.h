// A whole frame of samples at one spacing, and the mean of several such frames at other places in the samples' cells.
// In: a posed scene, a camera. Out: framelets as rendered and as displayed, and the picture of one pixel a sample.
#pragma once

#include <vector>

#include "common/image.h"
#include "server/render/framelet_renderer.h"

namespace framelet::bench {

class FrameGrid {
public:
    /// `spacing`: pixels from sample to sample: 1, 2 or 4.
    FrameGrid(Viewport viewport, int spacing);

    /// Begins anew: every sample at the middle of its cell. Returns how many rays that took.
    std::uint64_t render(RenderScene const& scene, Camera const& camera, float exposure);
    /// One more such frame of the same, at the next of `places` places in the cells. The mean is of light as displayed.
    std::uint64_t add(RenderScene const& scene, Camera const& camera, float exposure);

    /// After so many frames the mean is taken for the truth: with 16 some of the project's scenes stay below 38 dB.
    static constexpr int places = 64;

    int spacing() const { return spacing_; }
    int frames() const { return frames_; } ///< in the mean
    std::size_t samples() const { return tiles_.size() * framelet_samples; } ///< of one frame
    ImagePlane const& plane() const { return plane_; }
    /// Of the first frame: before exposure, with depths and bodies.
    std::vector<Framelet> const& rendered() const { return rendered_; }
    /// The mean. Before anything was rendered only the tiles are set.
    std::vector<DisplayFramelet> const& framelets() const { return displayed_; }
    /// The same as a picture of one pixel a sample.
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

/// A picture of one pixel a sample, samples `spacing` pixels apart, at full size: bilinear, in linear light.
void upsample(Picture const& samples, int spacing, Picture& out);

/// Writes the framelet's samples to a picture of one pixel a sample, reads them from there. Beyond its border nothing
/// is written, and its last pixels repeat.
void place_samples(DisplayFramelet const& framelet, Picture& picture);
void take_samples(Picture const& picture, DisplayFramelet& framelet);

} // namespace framelet::bench
