// One batch of one viewer on its way through the stages. In: what was planned, and for which picture. Out: the batch on
// the viewer's socket, and what was learnt from it. Rendering one batch and finishing another can go on side by side.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "common/per_thread.h"
#include "protocol/batch_codec.h"
#include "server/flow/lossy_places.h"
#include "server/flow/quality_choice.h"
#include "server/layers/shape_feed.h"
#include "server/render/probe_renderer.h"
#include "server/schedule/adaptive_refresh.h"
#include "server/session/cycle_record.h"
#include "server/session/session.h"

namespace framelet {

/// What is kept of a viewer from batch to batch.
struct ViewerState {
    AdaptiveRefresh refresh;
    ShapeFeed shapes;
    BodyMotions motions; ///< as the viewer knows them
    QualityChoice choice;
    LossyPlaces lossy;
};

/// What is seen, by all viewers.
struct SharedScene {
    Scene const& scene;
    std::span<Index const> clips;
    RenderScene const& render_scene; ///< posed
};

/// What is made.
struct BatchOrder {
    std::shared_ptr<Session> session;
    ViewerState* viewer = nullptr;
    SessionInput input;
    ViewState state;
    RefreshPlan plan;
    std::uint8_t quality = exact_quality;
    bool still = false; ///< nothing moves: what is finest is sent without loss
    bool again = false; ///< what the viewer holds with loss: there is nothing to learn
};

class BatchWork {
public:
    BatchOrder order; ///< set before `render`
    CycleRecord record;

    /// Parallel on the calling TBB arena.
    void render(SharedScene const& shared);
    /// What was rendered: learning, choice of quality, shapes. Not while the viewer's state is used otherwise.
    void learn(SharedScene const& shared);
    /// What was learnt: encoding, sending. `codec` may keep scratch from batch to batch. Returns whether the viewer's
    /// picture has become complete, or is no longer.
    bool send(BatchCodec& codec);

private:
    void describe_shapes(SharedScene const& shared);
    void begin_batch();

    PerThread<Framelet> fresh_;
    std::vector<Framelet> rendered_pool_; ///< as many as a batch ever had: making room for them costs time
    std::vector<DisplayFramelet> display_pool_;
    std::span<Framelet> rendered_; ///< without radiance, which would crowd the caches for nothing
    std::span<DisplayFramelet> display_;
    ProbeRenderer probes_;
    std::vector<std::uint8_t> needed_; ///< whether the viewer gets it, of each
    Batch batch_; ///< number 0: there is nothing to send
    bool complete_ = false; ///< with it the viewer's picture is
};

} // namespace framelet
