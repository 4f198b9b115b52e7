// The method `framelet`: the project's own server and viewer, the very pipelines that the programs run, driven on the
// virtual clock. `framelet-unwarped`: the same with the viewer's reprojection switched off.
#include <algorithm>
#include <deque>
#include <utility>

#include "protocol/codec/batch_codec.h"
#include "protocol/messages/message_codec.h"
#include "server/sampling/plan/render_rate.h"
#include "server/stream/framelet_stream.h"
#include "tests/evaluation/methods/methods.h"
#include "tests/evaluation/methods/warp_viewer.h"

namespace framelet::bench {
namespace {

class Framelets final : public Method {
public:
    Framelets(MethodSetup const& setup, bool reprojects)
        : setup_(setup), reprojects_(reprojects && setup.parts.reprojection), plane_(setup.viewport),
          viewer_(setup.viewport, setup.costs, picture_settings(reprojects_, setup.parts), setup.times),
          cells_((setup.viewport.width + cell - 1) / cell),
          times_(static_cast<std::size_t>(cells_) *
                 static_cast<std::size_t>((setup.viewport.height + cell - 1) / cell)) {}

    ServerStep produce(StepInput const& input) override {
        begin(input);
        if (input.view.number != view_number_) {
            view_number_ = input.view.number;
            stream_->take({clock(input.now), CameraUpdate{input.view, followed_camera_}});
        }
        if (input.clock_set) {
            stream_->take({clock(input.now), ClockChanged{}});
        }
        PosedScene& scene = *input.scene.posed;
        double const rate = rate_.samples_per_second > 0 ? rate_.samples_per_second : first_rate();
        ServerStep step;
        Step next{};
        double const planned = processor_seconds_of([&] {
            next = stream_->plan({clock(input.now), input.time, 1, rate, setup_.machine * plan_seconds()}, scene);
        });
        if (SessionTimes* const times = setup_.times; times != nullptr) {
            bool const plans = next == Step::render && stream_->planned_figures().is_new_cycle;
            (plans ? times->plan.measured : times->looking) += planned;
        }
        if (next != Step::render) {
            return step;
        }
        clocked(setup_.times, &SessionTimes::render, [&] {
            scene.pose(stream_->moment());
            stream_->render(scene);
        });
        bool sends = false;
        clocked(setup_.times, &SessionTimes::learn, [&] { sends = stream_->learn(scene); });
        TurnFigures const& figures = stream_->learnt_figures();
        double const planning = figures.is_new_cycle ? plan_seconds() : 0;
        step.seconds = seconds_of(figures, planning);
        step.samples = figures.rays + figures.probes;
        step.sent_samples = figures.exact_samples + figures.lossy_samples;
        step.begun = input.now;
        if (setup_.times != nullptr) {
            setup_.times->samples += step.sent_samples;
        }
        rate_ = update_render_rate(rate_, static_cast<double>(figures.rays),
                                   setup_.machine * (step.seconds.server() - planning)); // as in SessionLoop
        if (sends) {
            clocked(setup_.times, &SessionTimes::encode, [&] { step.message = encode_message(stream_->encode()); });
        }
        return step;
    }

    void sent(double now, double bytes) override {
        stream_->take({clock(now), BatchSent{stream_->last_batch(), static_cast<std::uint64_t>(bytes)}});
    }
    void answered(double now, double arrived) override {
        if (std::vector<SentTile>& framelets = evicted_.front(); !framelets.empty()) {
            stream_->take({clock(now), Evicted{std::move(framelets)}});
        }
        evicted_.pop_front();
        stream_->take({clock(now), Ack{++answered_, static_cast<std::uint64_t>(1e6 * clock(arrived)), 0}});
    }

    ViewerStep consume(std::vector<std::byte> const& message) override {
        Batch batch;
        clocked(setup_.times, &SessionTimes::decode,
                [&] { batch = codec_.decode(std::get<EncodedBatch>(decode_message(message)), &received_); });
        ViewerStep step = viewer_.insert(batch);
        viewer_.take_evicted(evicted_.emplace_back());
        double const decoding = batch.qp.empty() ? setup_.costs.decode_sample : setup_.costs.decode_lossy_sample;
        step.seconds.decode +=
            charged(setup_.times, &SessionTimes::decode,
                    1e-9 * static_cast<double>(batch.framelets.size() * framelet_samples) * decoding);
        for (DisplayFramelet const& framelet : batch.framelets) {
            stamp(plane_.tile_rect(framelet.tile), batch.scene_time);
        }
        return step;
    }

    ViewerStep present(NumberedView const& view, SceneTime time) override {
        bool const is_settled = stream_ && stream_->is_complete() && view.number == view_number_;
        return viewer_.present(view.camera, time, followed_camera_, is_settled);
    }

    Picture const& picture() const override { return viewer_.picture(); }

    double mean_sample_time() const override {
        double sum = 0;
        for (double const time : times_) {
            sum += time;
        }
        return sum / static_cast<double>(times_.size());
    }

    AdaptiveRefresh const* scheduler() const override { return stream_ ? stream_->scheduler() : nullptr; }

    /// A window that does not bind: the stream bounds what is on its way by itself.
    Window window() const override { return {2 * FrameletStream::max_batches_in_flight, false}; }

private:
    /// The clocks of server and viewer, seconds, which are never below 0.
    double clock(double now) const { return now + setup_.clock_offset; }

    void begin(StepInput const& input) {
        if (stream_) {
            return;
        }
        FrameletParts const& parts = setup_.parts;
        StreamOptions options;
        options.exposure = input.scene.exposure;
        options.batch_framelets = setup_.batch_framelets;
        options.bias = setup_.bias;
        options.limits = limits_of(parts);
        options.follows_link = parts.link_budget;
        options.skips = parts.skip;
        options.prices_bytes = parts.byte_prices;
        if (!parts.few_moments) {
            options.moment_seconds = least_cycle_seconds;
        }
        options.looks_ahead = parts.look_ahead;
        options.awaits_switches = parts.awaited_switches;
        options.camera_leads = parts.camera_lead;
        options.knows_rest = parts.rest;
        stream_.emplace(options, codings_of(parts));
        stream_->take({clock(input.now), ViewerSettings{0, 0, reprojects_}});
        followed_camera_ = input.scene.followed_camera();
    }

    static std::uint32_t codings_of(FrameletParts const& parts) {
        std::uint32_t const without_loss = coding::exact_colour | coding::shapes_and_tracks;
        return !parts.loss ? without_loss : parts.predictions ? coding::all : without_loss | coding::haar_colour;
    }

    static PictureSettings picture_settings(bool reprojects, FrameletParts const& parts) {
        PictureSettings settings;
        settings.reproject = reprojects;
        settings.moments = parts.held_moments ? settings.moments : FrameletPool::untried_moments + 1;
        settings.knows_rest = parts.rest;
        settings.parts.flat_contrast = parts.outline_filter ? flat_contrast : 255;
        settings.parts.keeps_cuts = parts.kept_cuts;
        return settings;
    }

    static ResponseLimits limits_of(FrameletParts const& parts) {
        ResponseLimits limits;
        if (!parts.spacing) {
            limits.least_level = limits.most_level = pixel_level;
        }
        limits.probe_share = parts.probes ? limits.probe_share : 0;
        limits.visibility_share = parts.visibility ? limits.visibility_share : 0;
        limits.plans_together = parts.planned_together;
        limits.coarse_first = parts.coarse_first;
        limits.most_rays = parts.four_rays ? four_rays : single_ray;
        limits.expects_change = parts.restlessness;
        return limits;
    }

    /// Time that the calibrated machine takes for a turn.
    StageSeconds seconds_of(TurnFigures const& figures, double planning) const {
        CostTable const& costs = setup_.costs;
        auto const nanoseconds = [](std::uint64_t count, double each) {
            return 1e-9 * static_cast<double>(count) * each;
        };
        auto const charge = [this](SessionTimes::Stage SessionTimes::*stage, double sum) {
            return charged(setup_.times, stage, sum);
        };
        StageSeconds seconds;
        seconds.render =
            charge(&SessionTimes::render, nanoseconds(figures.segments, costs.coherent_segment) +
                                              nanoseconds(figures.probe_segments, costs.incoherent_segment) +
                                              nanoseconds(figures.rays, costs.display_sample));
        seconds.response = charge(&SessionTimes::plan, planning) +
                           charge(&SessionTimes::learn, nanoseconds(figures.learnt_samples, costs.learn_sample) +
                                                            nanoseconds(figures.shaped_samples, costs.shape_sample));
        seconds.encode =
            charge(&SessionTimes::encode, nanoseconds(figures.exact_samples, costs.encode_sample) +
                                              nanoseconds(figures.lossy_samples, costs.encode_lossy_sample));
        return seconds;
    }

    /// Samples a second before any were measured, as in SessionLoop; slower machines are told their rate, as a run is
    /// too short to find it out.
    double first_rate() const {
        return std::min(first_samples_per_second,
                        setup_.frames_per_second * setup_.viewport.width * setup_.viewport.height);
    }

    /// Seconds that planning a cycle takes on the calibrated machine.
    double plan_seconds() const {
        auto const regions = static_cast<double>(stream_->scheduler()->regions().visible().size());
        return 1e-9 * regions * setup_.costs.plan_region;
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
    ImagePlane const plane_;
    std::optional<FrameletStream> stream_; ///< made in the first step, which says what is served
    int followed_camera_ = -1;
    std::uint64_t view_number_ = 0;
    RenderRate rate_;
    std::uint64_t answered_ = 0; ///< number of batches answered
    BatchCodec codec_;
    BatchMemory received_;
    std::deque<std::vector<SentTile>> evicted_; ///< evicted with each batch that is not answered yet
    WarpViewer viewer_;
    int const cells_; ///< number of cells in a row
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
