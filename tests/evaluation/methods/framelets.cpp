// `framelet`: the project's own server and viewer as they stand, the very stages that the programs run.
// `framelet-unwarped`: the same with the viewer's reprojection switched off.
#include "common/color.h"
#include "common/framelet_cache.h"
#include "common/reconstruction.h"
#include "common/reprojector.h"
#include "protocol/batch_codec.h"
#include "server/flow/lossy_places.h"
#include "server/flow/quality_choice.h"
#include "server/layers/shape_feed.h"
#include "server/render/probe_renderer.h"
#include "server/schedule/adaptive_refresh.h"
#include "server/schedule/render_rate.h"
#include "server/session/session.h"
#include "server/session/session_loop.h"
#include "tests/evaluation/methods/methods.h"

namespace framelet::bench {
namespace {

class Framelets final : public Method {
public:
    Framelets(MethodSetup const& setup, bool reprojects)
        : setup_(setup), reprojects_(reprojects), cache_(ImagePlane(setup.viewport)),
          picture_(setup.viewport.width, setup.viewport.height), cells_((setup.viewport.width + cell - 1) / cell),
          times_(static_cast<std::size_t>(cells_) *
                 static_cast<std::size_t>((setup.viewport.height + cell - 1) / cell)) {}

    ServerStep produce(StepInput const& input) override {
        moves_ = input.scene.duration > 0;
        SceneTime const time = moves_ ? input.time : 0;
        ViewState const state{input.view, input.scene.exposure, time};
        if (refresh_.is_complete(state)) {
            return lossy_.empty() ? ServerStep() : send_exactly(input, time);
        }
        RefreshInput refresh;
        refresh.state = state;
        refresh.now = input.now;
        LinkState const link = link_.state();
        double const rendered = rate_.samples_per_second > 0 ? rate_.samples_per_second : first_rate();
        std::uint8_t const quality = choice_.choose(link, rendered, input.now);
        bool const still = refresh_.is_still(state);
        refresh.samples_per_second = bounded_rate(link, rendered);
        refresh.cycle_seconds = cycle_length(still, setup_.machine * plan_seconds());
        refresh.delivery_seconds = static_cast<float>(link.delivery_seconds);
        refresh.batch_framelets = setup_.batch_framelets;
        refresh.link_framelets = bounded_batch(link);
        refresh.bias = static_cast<float>(setup_.bias);
        refresh.reprojects = reprojects_;
        RefreshPlan const& plan = refresh_.plan(refresh);
        if (plan.tiles.empty() && plan.probes.empty()) {
            return {};
        }
        ServerStep step;
        std::uint64_t const segments = render(input, plan.tiles);
        std::uint64_t const probe_segments = probes_.render(*input.scene.render_scene, input.view.camera,
                                                            setup_.viewport, input.scene.exposure, plan.probes);
        step.samples = plan.tiles.size() * framelet_samples + plan.probes.size();
        double const samples = static_cast<double>(plan.tiles.size() * framelet_samples);
        step.seconds.render = 1e-9 * (static_cast<double>(segments) * setup_.costs.coherent_segment +
                                      static_cast<double>(probe_segments) * setup_.costs.incoherent_segment);
        step.seconds.response = (plan.is_new_cycle ? plan_seconds() : 0) + 1e-9 * samples * setup_.costs.learn_sample;
        if (!plan.tiles.empty()) {
            rate_ = update_render_rate(rate_, static_cast<double>(step.samples), setup_.machine * step.seconds.render);
        }

        send_ = refresh_.learn(display_, rendered_, probes_.luma());
        send(input, time, plan.tiles, quality, still, step);
        return step;
    }

    void sent(double now, double bytes) override {
        link_.begin(static_cast<double>(batch_.framelets.size() * framelet_samples));
        link_.sent(number_, now, bytes);
    }
    void answered(double now, double arrived) override { link_.acknowledged(++answered_, now, arrived); }
    bool has_room(double now) const override { return link_.has_room(now); }

    ViewerStep consume(std::vector<std::byte> const& message) override {
        Batch const batch = codec_.decode(std::get<EncodedBatch>(decode_message(message)), &received_);
        cache_.insert(batch);
        for (BodyTrack const& track : batch.tracks) {
            motions_.extend(track);
        }
        double fine = 0;
        for (DisplayFramelet const& framelet : batch.framelets) {
            fine += cache_.plane().sample_spacing(framelet.tile) < 1 ? framelet_samples : 0;
            stamp(cache_.plane().tile_rect(framelet.tile), batch.scene_time);
        }
        double const samples = static_cast<double>(batch.framelets.size() * framelet_samples);
        ViewerStep step;
        double const decoding = batch.quality.empty() ? setup_.costs.decode_sample : setup_.costs.decode_lossy_sample;
        step.seconds.decode = 1e-9 * samples * (decoding + setup_.costs.cache_sample);
        if (!reprojects_) {
            cache_.take_changed(changed_);
            reconstruct(cache_, changed_, picture_);
            step.seconds.reconstruct = 1e-9 * (pixels_of(changed_) * setup_.costs.reconstruct_pixel +
                                               fine * setup_.costs.reconstruct_fine_sample);
        }
        return step;
    }

    ViewerStep present(NumberedView const& view, SceneTime time) override {
        ViewerStep step;
        if (reprojects_) {
            cache_.take_changed(changed_);
            reprojector_.show(cache_, changed_, view.camera, moves_ ? time : 0, motions_, picture_, repainted_);
            step.seconds.reconstruct =
                1e-9 * pixels_of(repainted_) *
                (reprojector_.is_exact() ? setup_.costs.reconstruct_pixel : setup_.costs.reproject_pixel);
        }
        return step;
    }

    Picture const& picture() const override { return picture_; }

    double mean_sample_time() const override {
        double sum = 0;
        for (double const time : times_) {
            sum += time;
        }
        return sum / static_cast<double>(times_.size());
    }

    AdaptiveRefresh const* scheduler() const override { return &refresh_; }

    Window window() const override { return {Session::max_batches_in_flight, false}; }

private:
    /// Renders and displays; returns the segments that it took.
    std::uint64_t render(StepInput const& input, std::span<Tile const> tiles) {
        rendered_.resize(tiles.size());
        std::uint64_t const segments = render_framelets(*input.scene.render_scene, input.view.camera,
                                                        ImagePlane(setup_.viewport), tiles, 0, rendered_);
        display_.clear();
        for (Framelet const& framelet : rendered_) {
            display_.push_back(to_display(framelet, input.scene.exposure));
        }
        return segments;
    }

    /// What the viewer was sent with loss once more, as the server does when the picture is complete.
    ServerStep send_exactly(StepInput const& input, SceneTime time) {
        constexpr std::size_t most_framelets = 1024;
        lossy_.list(std::min(bounded_batch(link_.state()), most_framelets), lossy_tiles_);
        ServerStep step;
        std::uint64_t const segments = render(input, lossy_tiles_);
        step.samples = lossy_tiles_.size() * framelet_samples;
        step.seconds.render = 1e-9 * static_cast<double>(segments) * setup_.costs.coherent_segment;
        send_.assign(lossy_tiles_.size(), 1);
        send(input, time, lossy_tiles_, exact_quality, true, step);
        return step;
    }

    /// The message of what was rendered, and what making it costs.
    void send(StepInput const& input, SceneTime time, std::span<Tile const> tiles, std::uint8_t quality, bool finish,
              ServerStep& step) {
        ImagePlane const plane(setup_.viewport);
        choose_qualities(plane, tiles, send_, quality, finish, lossy_, batch_.quality);
        batch_.framelets.clear();
        for (std::size_t i = 0; i < display_.size(); ++i) {
            if (send_[i] != 0) {
                batch_.framelets.push_back(display_[i]);
            }
        }
        double const samples = static_cast<double>(tiles.size() * framelet_samples);
        double const sent = static_cast<double>(batch_.framelets.size() * framelet_samples);
        double const coding = batch_.quality.empty() ? setup_.costs.encode_sample : setup_.costs.encode_lossy_sample;
        step.seconds.encode = 1e-9 * (samples * setup_.costs.display_sample + sent * coding);
        if (batch_.framelets.empty()) {
            return;
        }
        if (reprojects_) {
            shapes_.fit(rendered_, send_, make_view_rays(input.view.camera, setup_.viewport), plane, batch_.shapes);
            shapes_.track(input.scene.scene, input.scene.clips, input.scene.render_scene->bodies(), time,
                          batch_.tracks);
            step.seconds.encode += 1e-9 * sent * setup_.costs.shape_sample;
        }
        batch_.number = ++number_;
        batch_.view = input.view;
        batch_.scene_time = time;
        step.message = encode_message(codec_.encode(batch_, &sent_));
    }

    /// Before anything has been measured.
    double first_rate() const { return setup_.frames_per_second * setup_.viewport.width * setup_.viewport.height; }

    /// Of the calibrated machine, for a cycle.
    double plan_seconds() const {
        return 1e-9 * static_cast<double>(refresh_.field().visible().size()) * setup_.costs.plan_place;
    }

    static double pixels_of(std::vector<PixelRect> const& rects) {
        double pixels = 0;
        for (PixelRect const& rect : rects) {
            pixels += static_cast<double>(rect.width()) * rect.height();
        }
        return pixels;
    }

    static constexpr int cell = framelet_side >> finest_levels; ///< side of the finest tile, pixels

    void stamp(PixelRect const& rect, double time) {
        int const right = std::min(rect.right, picture_.width);
        for (int y = rect.top; y < std::min(rect.bottom, picture_.height); y += cell) {
            auto const row = times_.begin() + static_cast<std::ptrdiff_t>(y / cell) * cells_;
            std::fill(row + rect.left / cell, row + (right + cell - 1) / cell, time);
        }
    }

    MethodSetup const setup_;
    bool const reprojects_;
    bool moves_ = false; ///< the scene
    AdaptiveRefresh refresh_;
    RenderRate rate_;
    std::vector<Framelet> rendered_;
    std::vector<DisplayFramelet> display_;
    ProbeRenderer probes_;
    std::vector<std::uint8_t> send_; ///< whether the viewer gets it, of each
    std::vector<Tile> lossy_tiles_;
    LinkEstimate link_;
    QualityChoice choice_;
    LossyPlaces lossy_;
    ShapeFeed shapes_;
    Batch batch_;
    std::uint64_t answered_ = 0; ///< batches
    std::uint64_t number_ = 0;
    BatchCodec codec_;
    HeldPicture sent_, received_; ///< on the server's side, on the viewer's

    FrameletCache cache_;
    BodyMotions motions_;
    Reprojector reprojector_;
    std::vector<PixelRect> changed_, repainted_;
    Picture picture_;
    int const cells_; ///< in a row
    std::vector<double> times_; ///< scene time shown in each cell
};

} // namespace

std::unique_ptr<Method> make_framelet(MethodSetup const& setup) {
    return std::make_unique<Framelets>(setup, true);
}

std::unique_ptr<Method> make_framelet_unwarped(MethodSetup const& setup) {
    return std::make_unique<Framelets>(setup, false);
}

} // namespace framelet::bench
