// The project's own way of serving a viewer: what is to be seen -> a moment -> a plan of what is worth rendering ->
// framelets, learnt from, coded as the link asks for. In and out as `ViewerStream` says.
#pragma once

#include <array>

#include "server/stream/batch_work.h"
#include "server/stream/camera_forecast.h"
#include "server/stream/flow/link_estimate.h"
#include "server/stream/flow/qp_choice.h"
#include "server/stream/moment_choice.h"
#include "server/stream/viewer_stream.h"

namespace framelet {

struct StreamOptions {
    float exposure = 1; ///< factor on radiance, before the viewer's own
    ToneCurve tone_curve = ToneCurve::neutral;
    std::size_t batch_framelets = 0; ///< most framelets of one batch; 0: what half a cycle has time for
    double bias = 0; ///< -1 (spatial fidelity) .. 1 (temporal), before the viewer's own
    WorkerPool* workers = nullptr; ///< who trace paths with this process; null: nobody
    // The evaluation leaves parts out, to see what each is worth.
    ResponseLimits limits{};
    bool follows_link = true; ///< rate and batches are bounded by what the link carries
    bool skips = true; ///< what the viewer has already is not sent again
    bool prices_bytes = true; ///< where the link is scarce samples cost by the bytes that they take
    std::optional<double> moment_seconds{}; ///< how long a moment lasts; nothing: as long as is best
    bool looks_ahead = true; ///< a moment is of when it is shown, not of when it begins
    bool awaits_switches = true; ///< a moment is of what comes after a jump that is near, and shown from then on
    bool camera_leads = true; ///< the camera of a moment is ahead of it, where that helps
    bool knows_rest = true; ///< what rests is held as what stands
};

class FrameletStream final : public ViewerStream {
public:
    /// Batches that may be on their way (learnt, not yet acknowledged). Enough to keep the renderer busy while the
    /// viewer answers, few enough that what arrives is fresh.
    static constexpr std::uint64_t max_batches_in_flight = 32;

    /// `codings`: what the viewer can read, as its Hello says.
    FrameletStream(StreamOptions const& options, std::uint32_t codings);

    void take(StreamEvent const& event) override;
    Step plan(Turn const& turn, PosedScene& scene) override;
    SceneTime moment() const override { return planned_->order.state.scene_time; }
    void render(PosedScene const& scene) override;
    bool learn(PosedScene& scene) override;
    EncodedBatch encode() override;

    bool is_complete() const override { return complete_; }
    std::uint64_t last_batch() const override { return viewer_.batches; }
    TurnFigures const& planned_figures() const override { return planned_->figures; }
    TurnFigures const& learnt_figures() const override { return learnt_->figures; }

    AdaptiveRefresh const* scheduler() const override { return &viewer_.refresh; }
    /// The batch that was learnt last.
    Batch const& learnt_batch() const { return learnt_->batch(); }

private:
    bool takes_loss() const { return (codings_ & coding::haar_colour) != 0; }
    bool takes_predictions() const { return takes_loss() && (codings_ & coding::predicted_colour) != 0; }
    bool takes_shapes() const { return settings_.reproject && (codings_ & coding::shapes_and_tracks) != 0; }
    ViewState state_at(SceneTime clock, PosedScene& scene) const;
    int moving_camera(PosedScene const& scene) const;
    bool has_room(double now) const;
    Switches switches_ahead(Turn const& turn, PosedScene const& scene, double seconds) const;
    double samples_per_second(Turn const& turn) const;
    Camera camera_in(double seconds, Turn const& turn, PosedScene& scene) const;
    double travel_seconds() const;
    double camera_lead(Camera const& now, Camera const& then, Turn const& turn, PosedScene const& scene) const;
    double new_moment_seconds(bool camera_moves, Turn const& turn, PosedScene const& scene) const;
    HeldMoment new_moment(Turn const& turn, PosedScene& scene) const;
    std::optional<HeldMoment> moment_at(Turn const& turn, ViewState const& present, PosedScene& scene);
    Step plan_batch(Turn const& turn, ViewState const& present, PosedScene& scene);
    void plan_exactly(ViewState const& present, double now, PosedScene const& scene);
    BatchWork& free_work();
    void forget_viewer();
    void set_planned(BatchWork& work);

    StreamOptions const options_;
    std::uint32_t const codings_;
    std::optional<CameraUpdate> camera_;
    ViewerSettings settings_;
    std::uint64_t acknowledged_ = 0;
    LinkEstimate link_;
    QpChoice choice_;
    SentShare sent_share_;
    bool moves_samples_ = true; ///< the viewer does, of and to the camera that it looks through
    double rendered_per_second_ = 1; ///< rays a second, when a batch was planned last
    CameraForecast forecast_; ///< of a camera that is the viewer's own
    MomentChoice moments_;
    ViewerKnowledge viewer_;
    PathSums sums_; ///< of the picture, while it is at rest and not complete; used by `render` alone, or before

    std::array<BatchWork, 2> works_;
    BatchWork* planned_ = nullptr; ///< the work that was planned last, and is not learnt
    BatchWork* earlier_ = nullptr; ///< the one before, while it is not learnt
    BatchWork* learnt_ = nullptr; ///< the work that was learnt last
    bool complete_ = false;
    BatchCodec codec_;
    BatchMemory memory_; ///< of the batches that were encoded; the viewer has it once they have come
};

} // namespace framelet
