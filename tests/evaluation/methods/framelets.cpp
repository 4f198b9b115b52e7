// `framelet`: the project's own server and viewer as they stand, the very stages that the programs run.
// `framelet-unwarped`: the same with the viewer's reprojection switched off.
#include <algorithm>
#include <atomic>
#include <utility>

#include <tbb/parallel_for.h>

#include "common/per_thread.h"
#include "protocol/batch_codec.h"
#include "server/flow/lossy_places.h"
#include "server/flow/quality_choice.h"
#include "server/layers/shape_feed.h"
#include "server/render/display_renderer.h"
#include "server/render/probe_renderer.h"
#include "server/schedule/adaptive_refresh.h"
#include "server/schedule/render_rate.h"
#include "server/session/session.h"
#include "tests/evaluation/methods/methods.h"
#include "tests/evaluation/methods/warp_viewer.h"

namespace framelet::bench {
namespace {

class Framelets final : public Method {
public:
    Framelets(MethodSetup const& setup, bool reprojects)
        : setup_(setup), reprojects_(reprojects && setup.parts.reprojection), limits_(limits_of(setup.parts)),
          plane_(setup.viewport), viewer_(setup.viewport, setup.costs, setup.lag_seconds),
          cells_((setup.viewport.width + cell - 1) / cell),
          times_(static_cast<std::size_t>(cells_) *
                 static_cast<std::size_t>((setup.viewport.height + cell - 1) / cell)) {}

    ServerStep produce(StepInput const& input) override {
        moves_ = input.scene.duration > 0;
        SceneTime const time = moves_ ? input.time : 0;
        ViewState const state{input.view, input.scene.exposure, time};
        ServerStep step;
        if (refresh_.is_complete(state) && !rendered_) {
            if (!lossy_.empty()) {
                send_exactly(input, state, step);
            }
            return step;
        }
        if (refresh_.is_complete(state) || !link_.has_room(input.now)) {
            finish(input.scene, step);
            return step;
        }
        RefreshInput refresh;
        refresh.state = state;
        refresh.now = input.now;
        LinkState const link = link_.state();
        double const rendered = rate_.samples_per_second > 0 ? rate_.samples_per_second : first_rate();
        std::uint8_t const quality =
            setup_.parts.loss ? choice_.choose(link, rendered, input.now) : std::uint8_t{exact_quality};
        bool const still = refresh_.is_still(state);
        refresh.samples_per_second = setup_.parts.link_budget ? bounded_rate(link, rendered) : rendered;
        refresh.rendered_per_second = rendered;
        refresh.cycle_seconds = cycle_length(still, setup_.machine * plan_seconds());
        refresh.delivery_seconds = static_cast<float>(link.delivery_seconds);
        refresh.batch_framelets = setup_.batch_framelets;
        refresh.link_framelets = setup_.parts.link_budget ? bounded_batch(link) : max_batch_framelets;
        refresh.bias = static_cast<float>(setup_.bias);
        refresh.motions = reprojects_ ? &told_ : nullptr;
        refresh.limits = limits_;
        refresh_.plan(refresh, plan_);
        finish(input.scene, step);
        if (plan_.is_empty()) {
            return step;
        }
        step.seconds.response += plan_.is_new_cycle ? plan_seconds() : 0;
        std::swap(plan_, work_.plan);
        work_.state = state;
        work_.begun = input.now;
        work_.quality = quality;
        work_.still = still;
        work_.again = false;
        render(input, step.later);
        step.samples = work_.plan.ray_count() + work_.plan.probes.size();
        if (!work_.plan.tiles.empty()) {
            rate_ = update_render_rate(rate_, static_cast<double>(step.samples), setup_.machine * step.later.render);
        }
        if (!setup_.parts.pipelining) {
            step.seconds.render += std::exchange(step.later.render, 0);
            step.seconds.encode += std::exchange(step.later.encode, 0);
            finish(input.scene, step);
        }
        return step;
    }

    void sent(double now, double bytes) override {
        link_.begin(static_cast<double>(batch_.framelets.size() * framelet_samples));
        link_.sent(number_, now, bytes);
    }
    void answered(double now, double arrived) override { link_.acknowledged(++answered_, now, arrived); }
    bool has_room(double now) const override { return rendered_ || link_.has_room(now); }

    ViewerStep consume(std::vector<std::byte> const& message) override {
        Batch const batch = codec_.decode(std::get<EncodedBatch>(decode_message(message)), &received_);
        ViewerStep step = viewer_.insert(batch);
        double const decoding = batch.quality.empty() ? setup_.costs.decode_sample : setup_.costs.decode_lossy_sample;
        step.seconds.decode += 1e-9 * static_cast<double>(batch.framelets.size() * framelet_samples) * decoding;
        double fine = 0;
        for (DisplayFramelet const& framelet : batch.framelets) {
            fine += plane_.sample_spacing(framelet.tile) < 1 ? framelet_samples : 0;
            stamp(plane_.tile_rect(framelet.tile), batch.scene_time);
        }
        if (!reprojects_) {
            step.seconds.reconstruct =
                viewer_.present_unmoved().seconds.reconstruct + 1e-9 * fine * setup_.costs.reconstruct_fine_sample;
        }
        return step;
    }

    ViewerStep present(NumberedView const& view, SceneTime time) override {
        return reprojects_ ? viewer_.present(view.camera, moves_ ? time : 0) : ViewerStep{};
    }

    Picture const& picture() const override { return viewer_.picture(); }

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
    static ResponseLimits limits_of(FrameletParts const& parts) {
        ResponseLimits limits;
        if (!parts.spacing) {
            limits.least_level = limits.most_level = pixel_level;
        }
        if (!parts.price) {
            limits.least_price = limits.most_price = 1e-6f; // what the first cycle begins with
        }
        limits.probe_share = parts.probes ? limits.probe_share : 0;
        limits.inspection_share = parts.inspections ? limits.inspection_share : 0;
        return limits;
    }

    /// What is rendered, and finished with the next step, once that is planned.
    struct Work {
        ViewState state;
        RefreshPlan plan;
        double begun = 0;
        std::uint8_t quality = exact_quality;
        bool still = false;
        bool again = false; ///< what the viewer holds with loss
    };

    void render(StepInput const& input, StageSeconds& seconds) {
        RenderScene const& scene = *input.scene.render_scene;
        std::vector<Tile> const& tiles = work_.plan.tiles;
        ViewRays const rays = make_view_rays(input.view.camera, setup_.viewport);
        framelets_.resize(tiles.size());
        display_.resize(tiles.size());
        std::atomic<std::uint64_t> segments = 0;
        tbb::parallel_for(std::size_t{0}, tiles.size(), [&](std::size_t i) {
            segments += render_display(scene, rays, plane_, tiles[i], input.scene.exposure, work_.plan.rays_per_sample,
                                       fresh_.local(), framelets_[i], display_[i]);
        });
        std::uint64_t const probe_segments =
            probes_.render(scene, input.view.camera, setup_.viewport, input.scene.exposure, work_.plan.probes);
        seconds.render += 1e-9 * (static_cast<double>(segments) * setup_.costs.coherent_segment +
                                  static_cast<double>(probe_segments) * setup_.costs.incoherent_segment);
        seconds.encode += 1e-9 * static_cast<double>(work_.plan.ray_count()) * setup_.costs.display_sample;
        rendered_ = true;
    }

    /// What the viewer was sent with loss once more, as the server does when the picture is complete.
    void send_exactly(StepInput const& input, ViewState const& state, ServerStep& step) {
        constexpr std::size_t most_framelets = 1024;
        work_ = {state, {}, input.now, exact_quality, true, true};
        lossy_.list(std::min(bounded_batch(link_.state()), most_framelets), work_.plan.tiles);
        render(input, step.seconds);
        step.samples = work_.plan.tiles.size() * framelet_samples;
        finish(input.scene, step);
    }

    /// What follows for what was rendered, and the message of it; what that costs.
    void finish(BenchScene const& scene, ServerStep& step) {
        if (!std::exchange(rendered_, false)) {
            return;
        }
        double const samples = static_cast<double>(display_.size() * framelet_samples);
        if (work_.again) {
            send_.assign(display_.size(), 1);
        } else {
            send_ = refresh_.learn(work_.plan, display_, framelets_, probes_.luma());
            step.seconds.response += 1e-9 * samples * setup_.costs.learn_sample;
            if (!setup_.parts.withholding) {
                std::ranges::fill(send_, std::uint8_t{1});
            }
        }
        choose_qualities(plane_, work_.plan.tiles, send_, work_.quality, work_.still, lossy_, batch_.quality);
        batch_.framelets.clear();
        for (std::size_t i = 0; i < display_.size(); ++i) {
            if (send_[i] != 0) {
                batch_.framelets.push_back(display_[i]);
            }
        }
        if (batch_.framelets.empty()) {
            return;
        }
        double const sent = static_cast<double>(batch_.framelets.size() * framelet_samples);
        double const coding = batch_.quality.empty() ? setup_.costs.encode_sample : setup_.costs.encode_lossy_sample;
        step.seconds.encode += 1e-9 * sent * coding;
        if (reprojects_) {
            shapes_.fit(framelets_, send_, make_view_rays(work_.state.view.camera, setup_.viewport), plane_,
                        work_.plan.now, batch_.shapes);
            if (!work_.again) {
                bind_to_picture(work_.plan, send_, refresh_.staying(), batch_.shapes);
            }
            shapes_.track(scene.scene, scene.clips, scene.render_scene->bodies(), work_.state.scene_time,
                          batch_.tracks);
            for (BodyTrack const& track : batch_.tracks) {
                told_.extend(track);
            }
            step.seconds.encode += 1e-9 * sent * setup_.costs.shape_sample;
        }
        batch_.number = ++number_;
        batch_.view = work_.state.view;
        batch_.scene_time = work_.state.scene_time;
        step.message = encode_message(codec_.encode(batch_, &sent_));
        step.begun = work_.begun;
    }

    /// Before anything has been measured.
    double first_rate() const { return setup_.frames_per_second * setup_.viewport.width * setup_.viewport.height; }

    /// Of the calibrated machine, for a cycle.
    double plan_seconds() const {
        return 1e-9 * static_cast<double>(refresh_.field().visible().size()) * setup_.costs.plan_place;
    }

    static constexpr int cell = framelet_side >> finest_levels; ///< side of the finest tile, pixels

    void stamp(PixelRect const& rect, double time) {
        int const right = std::min(rect.right, setup_.viewport.width);
        for (int y = rect.top; y < std::min(rect.bottom, setup_.viewport.height); y += cell) {
            auto const row = times_.begin() + static_cast<std::ptrdiff_t>(y / cell) * cells_;
            std::fill(row + rect.left / cell, row + (right + cell - 1) / cell, time);
        }
    }

    MethodSetup const setup_;
    bool const reprojects_;
    ResponseLimits const limits_;
    ImagePlane const plane_;
    bool moves_ = false; ///< the scene
    AdaptiveRefresh refresh_;
    RenderRate rate_;
    RefreshPlan plan_;
    Work work_;
    bool rendered_ = false; ///< the work is, and not finished
    PerThread<Framelet> fresh_;
    std::vector<Framelet> framelets_; ///< without radiance
    std::vector<DisplayFramelet> display_;
    ProbeRenderer probes_;
    std::vector<std::uint8_t> send_; ///< whether the viewer gets it, of each
    LinkEstimate link_;
    QualityChoice choice_;
    LossyPlaces lossy_;
    ShapeFeed shapes_;
    Batch batch_;
    std::uint64_t answered_ = 0; ///< batches
    std::uint64_t number_ = 0;
    BatchCodec codec_;
    HeldPicture sent_, received_; ///< on the server's side, on the viewer's

    BodyMotions told_; ///< what the server has said
    WarpViewer viewer_;
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
