// The method `oracle`: shows what a choice of tiles can reach at all. It knows the reference for the moment at which a
// batch will be shown, and how each tile would look there at each spacing; each batch's samples go, one framelet after
// the other, to where the true error falls most. The viewer is that of `framed+warp`. A yardstick: what it knows costs
// nothing.
#include <algorithm>
#include <cmath>

#include "protocol/codec/batch_codec.h"
#include "protocol/messages/message_codec.h"
#include "server/stream/layers/shape_feed.h"
#include "tests/evaluation/methods/frame_forecast.h"
#include "tests/evaluation/methods/methods.h"
#include "tests/evaluation/methods/true_gain.h"
#include "tests/evaluation/methods/warp_viewer.h"

namespace framelet::bench {
namespace {

/// Seconds that the server works before it sends what it has.
constexpr double step_seconds = 1.0 / 60;
/// Seconds after its arrival at which a tile is judged, moved by the viewer, since it is shown for a while. With tiles
/// judged at their arrival a run of `vehicle_chase` at 128x128 has 1.4 times the error.
constexpr double seen_after = 0.02;
class Oracle final : public Method {
public:
    explicit Oracle(MethodSetup const& setup)
        : setup_(setup), plane_(setup.viewport), forecast_(setup, 0),
          gain_(setup.viewport, setup.costs, std::max(setup.rivals.spacing, 1)), mirror_(setup.viewport, setup.costs),
          viewer_(setup.viewport, setup.costs) {}

    ServerStep produce(StepInput const& input) override {
        FrameMoment moment = forecast_.moment(input);
        moment.camera = camera_at(input.scene, moment.time); // the oracle knows what the viewer will do as well
        if (input.now < next_look_ || input.waiting_bytes > 0) {
            return {};
        }
        moves_ = input.scene.duration > 0;
        SceneTime const seen = moment.time != input.time ? moment.time + seen_after : moment.time;
        mirror_.present(camera_at(input.scene, seen), moves_ ? seen : 0);
        gain_.look(input.scene, moment.time, seen, input.now, mirror_.picture());
        SceneTime const shown = moves_ ? moment.time : 0;
        std::vector<TrueGain::Chosen> const chosen = gain_.choose(batch_size_);
        if (chosen.empty()) {
            next_look_ = input.now + step_seconds;
            return {};
        }
        if (view_.number == 0 || !(view_.camera == moment.camera)) {
            view_ = {view_.number + 1, moment.camera, setup_.viewport};
        }
        return send(input, chosen, shown);
    }

    ViewerStep consume(std::vector<std::byte> const& message) override {
        Batch const batch = codec_.decode(std::get<EncodedBatch>(decode_message(message)), &received_);
        time_ = batch.scene_time;
        ViewerStep step = viewer_.insert(batch);
        step.seconds.decode +=
            1e-9 * static_cast<double>(batch.framelets.size() * framelet_samples) * setup_.costs.decode_sample;
        return step;
    }

    ViewerStep present(NumberedView const& view, SceneTime time) override {
        return viewer_.present(view.camera, moves_ ? time : 0);
    }

    Picture const& picture() const override { return viewer_.picture(); }
    /// Time of the newest batch: older tiles are kept for being good.
    double mean_sample_time() const override { return time_; }
    void sent(double now, double) override { forecast_.sent(now); }
    void answered(double, double arrived) override { forecast_.answered(arrived); }
    Window window() const override { return {16}; }

private:
    ServerStep send(StepInput const& input, std::vector<TrueGain::Chosen> const& chosen, SceneTime shown) {
        Batch batch;
        std::vector<Framelet> rendered;
        std::uint64_t segments = 0;
        for (TrueGain::Chosen const& one : chosen) {
            rendered.push_back(*one.rendered);
            batch.framelets.push_back(*one.displayed);
            segments += one.segments;
        }
        batch.number = ++number_;
        batch.view = view_;
        batch.scene_time = shown;
        std::vector<std::uint8_t> const all(rendered.size(), 1);
        shapes_.fit(rendered, all, make_view_rays(view_.camera, setup_.viewport), plane_, input.now, batch.shapes);
        shapes_.track(input.scene.scene, input.scene.clips, input.scene.render_scene->bodies(), -1, shown, shown,
                      batch.tracks, batch.camera_track);
        EncodedBatch const encoded = codec_.encode(batch, &sent_, false);
        mirror_.insert(codec_.decode(encoded, &mirrored_));

        CostTable const& costs = setup_.costs;
        ServerStep step;
        step.message = encode_message(encoded);
        step.samples = rendered.size() * framelet_samples;
        double const samples = static_cast<double>(step.samples);
        step.seconds.render = 1e-9 * static_cast<double>(segments) * costs.coherent_segment;
        step.seconds.encode = 1e-9 * samples * (costs.display_sample + costs.encode_sample + costs.shape_sample);
        double seconds = setup_.machine * step.seconds.server();
        if (setup_.bits_per_second > 0) {
            seconds = std::max(seconds, 8 * static_cast<double>(step.message.size()) / setup_.bits_per_second);
        }
        double const fitting = static_cast<double>(rendered.size()) * step_seconds / seconds;
        batch_size_ = std::max<std::size_t>(1, static_cast<std::size_t>(fitting));
        forecast_.begin(input.now, true);
        return step;
    }

    MethodSetup const setup_;
    ImagePlane const plane_;
    FrameForecast forecast_;
    TrueGain gain_;
    bool moves_ = false; ///< the scene moves
    double next_look_ = -INFINITY;
    std::size_t batch_size_ = 16;
    NumberedView view_;
    std::uint64_t number_ = 0;
    ShapeFeed shapes_;
    BatchCodec codec_;
    BatchMemory sent_, mirrored_, received_;
    WarpViewer mirror_, viewer_; ///< viewers with all that was sent, with all that has come
    double time_ = 0;
};

} // namespace

std::unique_ptr<Method> make_oracle(MethodSetup const& setup) {
    return std::make_unique<Oracle>(setup);
}

} // namespace framelet::bench
