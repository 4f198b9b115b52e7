// Samples at single places, for the methods without frames: how they are rendered, and the message that carries them.
#pragma once

#include <span>
#include <vector>

#include "common/math.h"
#include "tests/evaluation/method.h"

namespace framelet::bench {

struct PixelSample {
    std::uint16_t x, y;
    std::array<std::uint8_t, 3> rgb;
};

/// Renders the pixels at `places` (x and y given, rgb filled in). Returns rays traced.
std::uint64_t render_pixels(StepInput const& input, Viewport viewport, std::span<PixelSample> places);

/// Scene time, then 7 bytes a sample: random places and their colours hardly compress.
std::vector<std::byte> encode_samples(SceneTime time, std::span<PixelSample const> samples);

/// What the viewer of such a method keeps: the newest sample of every pixel.
class SampleViewer {
public:
    explicit SampleViewer(Viewport viewport);

    /// Returns how many samples the message brought.
    std::size_t consume(std::vector<std::byte> const& message);
    Picture const& picture() const { return picture_; }
    double mean_sample_time() const;

private:
    Picture picture_;
    std::vector<double> times_;
};

} // namespace framelet::bench
