// The method `framed`: whole frames in turn, sent without loss by the same codec as framelets, shown once all of a
// frame is there.
#include "protocol/codec/batch_codec.h"
#include "protocol/messages/message_codec.h"
#include "tests/evaluation/methods/methods.h"
#include "tests/evaluation/methods/whole_frame.h"

namespace framelet::bench {
namespace {

class Framed final : public Method {
public:
    explicit Framed(MethodSetup const& setup)
        : costs_(setup.costs), plane_(setup.viewport),
          frame_(setup, 1e-9 * pixel_count(setup.viewport) * (setup.costs.decode_sample + setup.costs.place_pixel)),
          picture_(setup.viewport.width, setup.viewport.height) {}

    ServerStep produce(StepInput const& input) override {
        ServerStep step = frame_.render(input);
        if (!frame_.is_due()) {
            return step;
        }
        batch_.number = ++number_;
        batch_.view = frame_.view();
        batch_.scene_time = frame_.time();
        batch_.framelets = frame_.grid().framelets();
        step.message = encode_message(codec_.encode(batch_));
        step.seconds.encode += 1e-9 * static_cast<double>(step.samples) * costs_.encode_sample;
        return step;
    }

    ViewerStep consume(std::vector<std::byte> const& message) override {
        Batch const batch = codec_.decode(std::get<EncodedBatch>(decode_message(message)));
        auto const spacing = static_cast<int>(plane_.sample_spacing(batch.framelets.front().tile));
        auto const along = [spacing](int side) { return (side + spacing - 1) / spacing; };
        samples_ = Picture(along(picture_.width), along(picture_.height));
        for (DisplayFramelet const& framelet : batch.framelets) {
            write_samples(framelet, samples_);
        }
        upsample(samples_, spacing, picture_);
        time_ = batch.scene_time;
        double const samples = static_cast<double>(batch.framelets.size() * framelet_samples);
        ViewerStep step;
        step.seconds.decode = 1e-9 * samples * costs_.decode_sample;
        step.seconds.reconstruct =
            1e-9 * pixel_count(plane_.viewport()) * (spacing > 1 ? costs_.reconstruct_pixel : costs_.place_pixel);
        return step;
    }

    Picture const& picture() const override { return picture_; }
    double mean_sample_time() const override { return time_; }
    void sent(double now, double) override { frame_.sent(now); }
    void answered(double, double arrived) override { frame_.answered(arrived); }

private:
    CostTable const costs_;
    ImagePlane const plane_;
    WholeFrame frame_;
    BatchCodec codec_;
    Batch batch_;
    std::uint64_t number_ = 0;
    Picture samples_, picture_;
    double time_ = 0;
};

} // namespace

std::unique_ptr<Method> make_framed(MethodSetup const& setup) {
    return std::make_unique<Framed>(setup);
}

} // namespace framelet::bench
