// `framed`: whole frames in turn, sent without loss by the same codec as framelets, shown when all of a frame is there.
#include "protocol/batch_codec.h"
#include "tests/evaluation/methods/methods.h"
#include "tests/evaluation/methods/whole_frame.h"

namespace framelet::bench {
namespace {

class Framed final : public Method {
public:
    explicit Framed(MethodSetup const& setup)
        : costs_(setup.costs), plane_(setup.viewport), frame_(setup),
          picture_(setup.viewport.width, setup.viewport.height) {}

    ServerStep produce(StepInput const& input) override {
        ServerStep step = frame_.render(input);
        batch_.number = ++number_;
        batch_.view = input.view;
        batch_.scene_time = input.time;
        batch_.framelets = frame_.framelets();
        step.message = encode_message(codec_.encode(batch_));
        step.seconds.encode += 1e-9 * static_cast<double>(step.samples) * costs_.encode_sample;
        return step;
    }

    ViewerStep consume(std::vector<std::byte> const& message) override {
        Batch const batch = codec_.decode(std::get<EncodedBatch>(decode_message(message)));
        for (DisplayFramelet const& framelet : batch.framelets) {
            place_framelet(framelet, plane_, picture_);
        }
        time_ = batch.scene_time;
        ViewerStep step;
        step.seconds.decode =
            1e-9 * static_cast<double>(batch.framelets.size() * framelet_samples) * costs_.decode_sample;
        step.seconds.reconstruct = 1e-9 * static_cast<double>(frame_.pixels()) * costs_.place_pixel;
        return step;
    }

    Picture const& picture() const override { return picture_; }
    double mean_sample_time() const override { return time_; }

private:
    CostTable const costs_;
    ImagePlane const plane_;
    WholeFrame frame_;
    BatchCodec codec_;
    Batch batch_;
    std::uint64_t number_ = 0;
    Picture picture_;
    double time_ = 0;
};

} // namespace

std::unique_ptr<Method> make_framed(MethodSetup const& setup) {
    return std::make_unique<Framed>(setup);
}

} // namespace framelet::bench
