// `framed+warp`: whole frames in turn, colour through x264, with each frame where its samples lie and what carries
// them, from which the viewer moves the last frame to its own camera and scene time whenever it shows a picture. What
// remote hybrid rendering and the runtimes of headsets do with a frame's depth plane, by the project's own shapes.
#include <algorithm>

#include "protocol/batch_codec.h"
#include "server/layers/shape_feed.h"
#include "tests/evaluation/codecs/h264_codec.h"
#include "tests/evaluation/methods/methods.h"
#include "tests/evaluation/methods/warp_viewer.h"
#include "tests/evaluation/methods/whole_frame.h"

namespace framelet::bench {
namespace {

/// However much its shapes take, colour gets this share of what a frame may take.
constexpr double least_colour_share = 0.1;

class FramedWarp final : public Method {
public:
    explicit FramedWarp(MethodSetup const& setup)
        : setup_(setup), plane_(setup.viewport), frame_(setup),
          encoder_(setup.viewport.width, setup.viewport.height, setup.frames_per_second),
          decoded_(setup.viewport.width, setup.viewport.height), viewer_(setup.viewport, setup.costs) {
        Batch blank;
        blank.view.viewport = setup.viewport;
        for (DisplayFramelet const& framelet : frame_.framelets()) {
            blank.framelets.push_back({framelet.tile, {}, {}, {}});
        }
        blank_ = codec_.encode(blank);
    }

    ServerStep produce(StepInput const& input) override {
        moves_ = input.scene.duration > 0;
        ServerStep step = frame_.render(input);
        Batch batch;
        batch.number = ++number_;
        batch.view = input.view;
        batch.scene_time = moves_ ? input.time : 0;
        batch.framelets = frame_.framelets();
        std::vector<std::uint8_t> const all(batch.framelets.size(), 1);
        shapes_.fit(frame_.rendered(), all, make_view_rays(input.view.camera, setup_.viewport), plane_, input.now,
                    batch.shapes);
        shapes_.track(input.scene.scene, input.scene.clips, input.scene.render_scene->bodies(), -1, batch.scene_time,
                      batch.tracks);
        // The message is a batch's whose payload is the access unit and whose tiles go without saying.
        EncodedBatch message = codec_.encode(batch);
        message.tiles.clear();
        message.payload.clear();
        double const encoding = 1e-9 * (static_cast<double>(frame_.pixels()) * setup_.costs.h264_encode_pixel +
                                        static_cast<double>(step.samples) * setup_.costs.shape_sample);
        double const budget = frame_.budget(input, step, encoding);
        double const beside = static_cast<double>(encode_message(message).size());
        message.payload = encoder_.encode(frame_.picture(), std::max(budget - beside, least_colour_share * budget));
        step.message = encode_message(message);
        step.seconds.encode += encoding;
        return step;
    }

    ViewerStep consume(std::vector<std::byte> const& message) override {
        auto encoded = std::get<EncodedBatch>(decode_message(message));
        decoder_.decode(encoded.payload, decoded_);
        encoded.payload = blank_.payload;
        encoded.tiles = blank_.tiles;
        Batch batch = codec_.decode(encoded);
        for (DisplayFramelet& framelet : batch.framelets) {
            take_framelet(decoded_, plane_, framelet);
        }
        time_ = batch.scene_time;
        ViewerStep step = viewer_.insert(batch);
        step.seconds.decode += 1e-9 * static_cast<double>(frame_.pixels()) * setup_.costs.h264_decode_pixel;
        return step;
    }

    ViewerStep present(NumberedView const& view, SceneTime time) override {
        return viewer_.present(view.camera, moves_ ? time : 0);
    }

    Picture const& picture() const override { return viewer_.picture(); }
    double mean_sample_time() const override { return time_; }

private:
    MethodSetup const setup_;
    ImagePlane const plane_;
    bool moves_ = false; ///< the scene
    WholeFrame frame_;
    ShapeFeed shapes_;
    H264Encoder encoder_;
    H264Decoder decoder_;
    BatchCodec codec_;
    EncodedBatch blank_; ///< a frame's tiles, and a payload that stands for colours which come otherwise
    std::uint64_t number_ = 0;
    Picture decoded_;
    WarpViewer viewer_;
    double time_ = 0;
};

} // namespace

std::unique_ptr<Method> make_framed_warp(MethodSetup const& setup) {
    return std::make_unique<FramedWarp>(setup);
}

} // namespace framelet::bench
