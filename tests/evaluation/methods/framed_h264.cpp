// `framed+h264`: whole frames in turn through x264, no frame larger than the link carries in its time.
#include "tests/evaluation/codecs/h264_codec.h"
#include "tests/evaluation/methods/methods.h"
#include "tests/evaluation/methods/whole_frame.h"

namespace framelet::bench {
namespace {

class FramedH264 final : public Method {
public:
    explicit FramedH264(MethodSetup const& setup)
        : setup_(setup), frame_(setup), encoder_(setup.viewport.width, setup.viewport.height, setup.frames_per_second),
          picture_(setup.viewport.width, setup.viewport.height) {}

    ServerStep produce(StepInput const& input) override {
        ServerStep step = frame_.render(input);
        double const encoding = 1e-9 * static_cast<double>(frame_.pixels()) * setup_.costs.h264_encode_pixel;
        auto const bytes = encoder_.encode(frame_.picture(), frame_.budget(input, step, encoding));
        step.message = WholeFrame::timed(input.time, bytes);
        step.seconds.encode += encoding;
        return step;
    }

    ViewerStep consume(std::vector<std::byte> const& message) override {
        decoder_.decode(WholeFrame::untimed(message, time_), picture_);
        ViewerStep step;
        step.seconds.decode = 1e-9 * static_cast<double>(frame_.pixels()) * setup_.costs.h264_decode_pixel;
        return step;
    }

    Picture const& picture() const override { return picture_; }
    double mean_sample_time() const override { return time_; }

private:
    MethodSetup const setup_;
    WholeFrame frame_;
    H264Encoder encoder_;
    H264Decoder decoder_;
    Picture picture_;
    double time_ = 0;
};

} // namespace

std::unique_ptr<Method> make_framed_h264(MethodSetup const& setup) {
    return std::make_unique<FramedH264>(setup);
}

} // namespace framelet::bench
