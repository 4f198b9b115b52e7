// `framed+jpeg`: whole frames in turn as JPEG, the quality chosen for the link.
#include <map>

#include "tests/evaluation/codecs/jpeg_codec.h"
#include "tests/evaluation/methods/frame_message.h"
#include "tests/evaluation/methods/methods.h"
#include "tests/evaluation/methods/whole_frame.h"

namespace framelet::bench {
namespace {

class FramedJpeg final : public Method {
public:
    explicit FramedJpeg(MethodSetup const& setup)
        : setup_(setup), frame_(setup, 1e-9 * pixel_count(setup.viewport) * setup.costs.jpeg_decode_pixel),
          picture_(setup.viewport.width, setup.viewport.height) {}

    ServerStep produce(StepInput const& input) override {
        ServerStep step = frame_.render(input);
        // Once nothing moves nothing waits for the link: the last picture is sent again as well as it can be.
        bool const last = frame_.is_converged() && last_quality_ < JpegRate::best && input.waiting_bytes == 0;
        if (!frame_.is_due() && !last) {
            return step;
        }
        if (!frame_.is_due()) {
            frame_.repeat(input.now);
        }
        FrameGrid& grid = frame_.grid();
        Picture const& picture = grid.picture();
        double const encoding = 1e-9 * pixel_count(picture) * setup_.costs.jpeg_encode_pixel;
        double const budget = frame_.budget(input, step, encoding);
        JpegRate& rate = rates_[grid.spacing()];
        last_quality_ = frame_.is_due() ? rate.quality(budget) : JpegRate::best;
        auto const bytes = codec_.encode(picture, last_quality_);
        rate.took(last_quality_, bytes.size());
        step.message = frame_message({frame_.time(), static_cast<double>(grid.spacing())}, bytes);
        step.seconds.encode += encoding;
        return step;
    }

    ViewerStep consume(std::vector<std::byte> const& message) override {
        auto const unit = access_unit(message, header_);
        auto const spacing = static_cast<int>(header_.spacing);
        codec_.decode(unit, decoded_);
        upsample(decoded_, spacing, picture_);
        ViewerStep step;
        step.seconds.decode = 1e-9 * pixel_count(decoded_) * setup_.costs.jpeg_decode_pixel;
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
    JpegCodec codec_;
    std::map<int, JpegRate> rates_; ///< by spacing
    int last_quality_ = JpegRate::best;
    Picture decoded_, picture_;
    FrameHeader header_;
};

} // namespace

std::unique_ptr<Method> make_framed_jpeg(MethodSetup const& setup) {
    return std::make_unique<FramedJpeg>(setup);
}

} // namespace framelet::bench
