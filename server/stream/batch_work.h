// One batch of one viewer on its way through the stages. In: what was planned, and for which picture. Out: the encoded
// batch, and what was learnt from it. Rendering one batch and finishing another can go on side by side.
#pragma once

#include <span>
#include <vector>

#include "common/per_thread.h"
#include "protocol/codec/batch_codec.h"
#include "server/render/path/path_light.h"
#include "server/render/probe_renderer.h"
#include "server/sampling/plan/adaptive_refresh.h"
#include "server/stream/flow/qp_choice.h"
#include "server/stream/layers/shape_feed.h"
#include "server/stream/posed_scene.h"
#include "server/stream/viewer_stream.h"
#include "server/workers/path_round.h"

namespace framelet {

/// State of one viewer that is kept from batch to batch, and changes as batches are learnt.
struct ViewerKnowledge {
    AdaptiveRefresh refresh;
    ShapeFeed shapes;
    BodyMotions motions; ///< as the viewer knows them
    std::uint64_t batches = 0; ///< how many have been learnt, and are sent
};

/// Order for a batch: what it is to be made of.
struct BatchOrder {
    ViewState state; ///< what is rendered
    ViewState present; ///< what is to be seen
    int scene_camera = -1; ///< moving camera of the scene that the viewer looks through; -1: none
    SceneTime shown_from = 0; ///< as `Batch::shown_from`
    bool outdates = false; ///< as `Batch::outdates`
    RefreshPlan plan;
    std::uint8_t qp = lossless_qp;
    bool takes_shapes = false;
    bool skips = true; ///< what the viewer has already is not sent
    int last_depth = -1; ///< of tiles after which none come, as nothing moves: they are sent without loss
    bool again = false; ///< what the viewer holds with loss is sent once more: there is nothing to learn
};

class BatchWork {
public:
    BatchOrder order; ///< set before `render`
    TurnFigures figures;

    /// Renders what is ordered, in parallel on the calling TBB arena, paths with the workers (null: there are none).
    /// `sums` are of the viewer's picture, where it is at rest and its light is found by paths.
    void render(PosedScene const& scene, PathSums& sums, WorkerPool* workers);
    /// Learns what was rendered; chooses QPs, makes shapes. Not to be called while the viewer's knowledge is used
    /// otherwise. False where there is nothing to send.
    bool learn(PosedScene& scene, ViewerKnowledge& viewer);
    /// Encodes what was learnt. `codec` may keep scratch from batch to batch; the rest as of `BatchCodec::encode`.
    EncodedBatch encode(BatchCodec& codec, BatchMemory& memory, bool predicts) {
        return codec.encode(batch_, &memory, predicts);
    }

    Batch const& batch() const { return batch_; }

private:
    std::size_t begin_paths(PosedScene const& scene, PathSums& sums, WorkerPool* workers);
    void show_paths(PosedScene const& scene, std::size_t index, std::size_t first_path, PathSums& sums);
    std::size_t light_paths(LightGathering const& gathering, std::size_t framelets) const;
    void describe_shapes(PosedScene& scene, ViewerKnowledge& viewer);
    void fill_batch(ViewerKnowledge& viewer);

    PerThread<Framelet> fresh_;
    std::vector<Framelet> rendered_pool_; ///< as many as a batch ever had: making room for them costs time
    std::vector<DisplayFramelet> display_pool_;
    std::span<Framelet> rendered_; ///< without radiance, which would crowd the caches for nothing
    std::span<DisplayFramelet> display_;
    /// What paths show is noise to probes and plan: to these it is as it is rendered without. Empty: there are no
    /// paths.
    std::vector<DisplayFramelet> direct_;
    std::vector<float> errors_; ///< left by paths, of each framelet; empty: there are none
    PathRound round_;
    std::vector<std::size_t> first_path_; ///< of each framelet, among those of the round
    ProbeRenderer probes_;
    std::vector<float> visibility_; ///< inverse depths, where the plan asks for them
    std::vector<std::uint8_t> needed_; ///< by framelet: whether the viewer gets it
    std::vector<std::size_t> sent_; ///< indices of those
    Batch batch_;
    std::vector<FrameletShape> loose_shapes_; ///< scratch: of samples that the viewer does not move
};

} // namespace framelet
