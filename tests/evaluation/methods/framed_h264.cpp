// The method `framed+h264`: whole frames in turn through x264, no frame larger than the link carries in its time.
#include "tests/evaluation/methods/h264_frames.h"
#include "tests/evaluation/methods/methods.h"
#include "tests/evaluation/methods/whole_frame.h"

namespace framelet::bench {
namespace {

class FramedH264 final : public Method {
public:
    explicit FramedH264(MethodSetup const& setup)
        : encode_pixel_(setup.costs.h264_encode_pixel),
          frame_(setup, 1e-9 * pixel_count(setup.viewport) * setup.costs.h264_decode_pixel),
          encoder_(setup.frames_per_second), viewer_(setup) {}

    ServerStep produce(StepInput const& input) override {
        ServerStep step = frame_.render(input);
        if (!frame_.is_due() && !frame_.repeats(input, last_bytes_)) {
            return step;
        }
        FrameGrid& grid = frame_.grid();
        Picture const& picture = grid.picture();
        double const encoding = 1e-9 * pixel_count(picture) * encode_pixel_;
        auto const bytes = encoder_.encode(grid.spacing(), picture, frame_.budget(input, step, encoding));
        last_bytes_ = bytes.size();
        step.message = frame_message({frame_.time(), static_cast<double>(grid.spacing())}, bytes);
        step.seconds.encode += encoding;
        return step;
    }

    ViewerStep consume(std::vector<std::byte> const& message) override { return viewer_.consume(message); }
    Picture const& picture() const override { return viewer_.picture(); }
    double mean_sample_time() const override { return viewer_.time(); }
    void sent(double now, double) override { frame_.sent(now); }
    void answered(double, double arrived) override { frame_.answered(arrived); }

private:
    double const encode_pixel_; ///< cost of encoding a pixel, nanoseconds
    WholeFrame frame_;
    ScaledH264Encoder encoder_;
    std::size_t last_bytes_ = 0;
    H264FrameViewer viewer_;
};

} // namespace

std::unique_ptr<Method> make_framed_h264(MethodSetup const& setup) {
    return std::make_unique<FramedH264>(setup);
}

} // namespace framelet::bench
