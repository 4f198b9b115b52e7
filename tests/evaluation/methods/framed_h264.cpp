// `framed+h264`: whole frames in turn through x264, no frame larger than the link carries in its time.
#include "tests/evaluation/methods/frame_message.h"
#include "tests/evaluation/methods/methods.h"
#include "tests/evaluation/methods/scaled_h264.h"
#include "tests/evaluation/methods/whole_frame.h"

namespace framelet::bench {
namespace {

class FramedH264 final : public Method {
public:
    explicit FramedH264(MethodSetup const& setup)
        : setup_(setup), frame_(setup, 1e-9 * pixel_count(setup.viewport) * setup.costs.h264_decode_pixel),
          encoder_(setup.frames_per_second), picture_(setup.viewport.width, setup.viewport.height) {}

    ServerStep produce(StepInput const& input) override {
        ServerStep step = frame_.render(input);
        if (!frame_.is_due() && !frame_.repeats(input, last_bytes_)) {
            return step;
        }
        FrameGrid& grid = frame_.grid();
        Picture const& picture = grid.picture();
        double const encoding = 1e-9 * pixel_count(picture) * setup_.costs.h264_encode_pixel;
        auto const bytes = encoder_.encode(grid.spacing(), picture, frame_.budget(input, step, encoding));
        last_bytes_ = bytes.size();
        step.message = frame_message({frame_.time(), static_cast<double>(grid.spacing())}, bytes);
        step.seconds.encode += encoding;
        return step;
    }

    ViewerStep consume(std::vector<std::byte> const& message) override {
        auto const unit = access_unit(message, header_);
        auto const spacing = static_cast<int>(header_.spacing);
        decoder_.decode(spacing, unit, decoded_);
        upsample(decoded_, spacing, picture_);
        ViewerStep step;
        step.seconds.decode = 1e-9 * pixel_count(decoded_) * setup_.costs.h264_decode_pixel;
        step.seconds.reconstruct = spacing > 1 ? 1e-9 * pixel_count(picture_) * setup_.costs.reconstruct_pixel : 0;
        return step;
    }

    Picture const& picture() const override { return picture_; }
    double mean_sample_time() const override { return header_.time; }
    void sent(double now, double) override { frame_.sent(now); }
    void answered(double, double arrived) override { frame_.answered(arrived); }

private:
    MethodSetup const setup_;
    WholeFrame frame_;
    ScaledH264Encoder encoder_;
    ScaledH264Decoder decoder_;
    std::size_t last_bytes_ = 0;
    Picture decoded_, picture_;
    FrameHeader header_;
};

} // namespace

std::unique_ptr<Method> make_framed_h264(MethodSetup const& setup) {
    return std::make_unique<FramedH264>(setup);
}

} // namespace framelet::bench
