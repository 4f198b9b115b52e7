// One batch of one viewer on its way through the stages. In: what was planned, and for which picture. Out: the encoded
// batch, and what was learnt from it. Rendering one batch and finishing another can go on side by side.
#pragma once

#include <span>
#include <vector>

#include "common/per_thread.h"
#include "protocol/codec/batch_codec.h"
#include "server/render/probe_renderer.h"
#include "server/sampling/plan/adaptive_refresh.h"
#include "server/stream/flow/lossy_tiles.h"
#include "server/stream/layers/shape_feed.h"
#include "server/stream/posed_scene.h"
#include "server/stream/viewer_stream.h"

namespace framelet {

/// What is kept of a viewer from batch to batch, and changes as batches are learnt.
struct ViewerKnowledge {
    AdaptiveRefresh refresh;
    ShapeFeed shapes;
    BodyMotions motions; ///< as the viewer knows them
    LossyTiles lossy;
    std::uint64_t batches = 0; ///< that have been learnt, and are sent
};

/// What is made.
struct BatchOrder {
    ViewState state; ///< what is rendered
    ViewState present; ///< what is to be seen
    int scene_camera = -1; ///< >= 0: the viewer looks through that one
    SceneTime shown_from = 0; ///< as of a Batch
    bool outdates = false; ///< as of a Batch
    RefreshPlan plan;
    std::uint8_t qp = lossless_qp;
    bool takes_shapes = false;
    bool skips = true; ///< what the viewer has already
    bool still = false; ///< nothing moves: what is finest is sent without loss
    bool again = false; ///< what the viewer holds with loss: there is nothing to learn
};

class BatchWork {
public:
    BatchOrder order; ///< set before `render`
    TurnFigures figures;

    /// Parallel on the calling TBB arena.
    void render(PosedScene const& scene);
    /// What was rendered: learning, choice of QP, shapes. Not while the viewer's knowledge is used otherwise.
    /// False where there is nothing to send.
    bool learn(PosedScene const& scene, ViewerKnowledge& viewer);
    /// What was learnt. `codec` may keep scratch from batch to batch; the rest as of `BatchCodec::encode`.
    EncodedBatch encode(BatchCodec& codec, BatchMemory& memory, bool predicts) {
        return codec.encode(batch_, &memory, predicts);
    }

    std::span<Framelet const> rendered() const { return rendered_; }
    Batch const& batch() const { return batch_; }

private:
    void describe_shapes(PosedScene const& scene, ViewerKnowledge& viewer);
    void fill_batch(ViewerKnowledge& viewer);

    PerThread<Framelet> fresh_;
    std::vector<Framelet> rendered_pool_; ///< as many as a batch ever had: making room for them costs time
    std::vector<DisplayFramelet> display_pool_;
    std::span<Framelet> rendered_; ///< without radiance, which would crowd the caches for nothing
    std::span<DisplayFramelet> display_;
    ProbeRenderer probes_;
    std::vector<float> visibility_; ///< inverse depths, where the plan asks for them
    std::vector<std::uint8_t> needed_; ///< whether the viewer gets it, of each
    Batch batch_;
};

} // namespace framelet
