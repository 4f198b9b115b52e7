// Common base of the methods without frames: the server renders single pixels, a little at a time, and the viewer shows
// each as soon as it comes.
#pragma once

#include <array>
#include <vector>

#include "tests/evaluation/method.h"

namespace framelet::bench {

struct PixelSample {
    std::uint16_t x, y;
    std::array<std::uint8_t, 3> rgb;
};

class SinglePixels : public Method {
public:
    explicit SinglePixels(MethodSetup const& setup);

    ViewerStep consume(std::vector<std::byte> const& message) final;
    Picture const& picture() const final { return picture_; }
    double mean_sample_time() const final;
    Window window() const final { return {16}; }

protected:
    std::size_t pixel_count() const { return times_.size(); }

    /// Renders the pixels of `batch_`, whose x and y are given, and sends them. `response_ns`: cost of choosing a
    /// sample, besides. Sets `batch_size_` to the number of samples for which such a step has time.
    ServerStep send_batch(StepInput const& input, double response_ns);

    MethodSetup const setup_;
    std::vector<PixelSample> batch_;
    std::size_t batch_size_ = 256;

private:
    Picture picture_;
    std::vector<double> times_; ///< scene time of the newest sample of every pixel
};

} // namespace framelet::bench
