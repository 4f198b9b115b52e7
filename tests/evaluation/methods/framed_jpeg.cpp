// `framed+jpeg`: whole frames in turn as JPEG, the quality chosen for the link.
#include "tests/evaluation/codecs/jpeg_codec.h"
#include "tests/evaluation/methods/methods.h"
#include "tests/evaluation/methods/whole_frame.h"

namespace framelet::bench {
namespace {

class FramedJpeg final : public Method {
public:
    explicit FramedJpeg(MethodSetup const& setup)
        : setup_(setup), frame_(setup), picture_(setup.viewport.width, setup.viewport.height) {}

    ServerStep produce(StepInput const& input) override {
        ServerStep step = frame_.render(input);
        double const encoding = 1e-9 * static_cast<double>(frame_.pixels()) * setup_.costs.jpeg_encode_pixel;
        int const quality = rate_.quality(frame_.budget(input, step, encoding));
        auto const bytes = codec_.encode(frame_.picture(), quality);
        rate_.took(quality, bytes.size());
        step.message = WholeFrame::timed(input.time, bytes);
        step.seconds.encode += encoding;
        return step;
    }

    ViewerStep consume(std::vector<std::byte> const& message) override {
        codec_.decode(WholeFrame::untimed(message, time_), picture_);
        ViewerStep step;
        step.seconds.decode = 1e-9 * static_cast<double>(frame_.pixels()) * setup_.costs.jpeg_decode_pixel;
        return step;
    }

    Picture const& picture() const override { return picture_; }
    double mean_sample_time() const override { return time_; }

private:
    MethodSetup const setup_;
    WholeFrame frame_;
    JpegCodec codec_;
    JpegRate rate_;
    Picture picture_;
    double time_ = 0;
};

} // namespace

std::unique_ptr<Method> make_framed_jpeg(MethodSetup const& setup) {
    return std::make_unique<FramedJpeg>(setup);
}

} // namespace framelet::bench
