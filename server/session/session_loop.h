// The server's loop: for every viewer, newest camera and scene time -> tile selection -> rendering -> encoding ->
// display values -> what was learnt -> encoding -> socket. Encoding and sending of one batch overlap the rendering of
// the next.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include <tbb/enumerable_thread_specific.h>

#include "protocol/batch_codec.h"
#include "server/flow/lossy_places.h"
#include "server/flow/quality_choice.h"
#include "server/layers/shape_feed.h"
#include "server/render/probe_renderer.h"
#include "server/schedule/adaptive_refresh.h"
#include "server/schedule/render_rate.h"
#include "server/session/recorder.h"
#include "server/session/scene_clock.h"
#include "server/session/session.h"

namespace framelet {

struct LoopOptions {
    float exposure = 1; ///< factor on radiance, before the viewer's own
    std::size_t batch_framelets = 0; ///< most framelets of one batch; 0: what half a cycle has time for
    double bias = 0; ///< -1 (spatial fidelity) .. 1 (temporal), before the viewer's own
    Recorder* recorder = nullptr; ///< must outlive the loop; null: nothing is recorded
};

class SessionLoop {
public:
    using Sessions = std::vector<std::shared_ptr<Session>>;

    /// What the loop asks of its server; both may be called on the loop's thread.
    struct Events {
        std::function<Sessions()> open_sessions;
        /// A session's picture is complete, or no longer.
        std::function<void()> convergence_changed;
    };

    /// Scene and clock must outlive the loop.
    SessionLoop(Scene const& scene, std::vector<Index> clips, RenderScene& render_scene, SceneClock const& clock,
                LoopOptions options, Events events);
    ~SessionLoop();

    /// Until `stop`; on the calling thread, with the worker threads of its TBB arena.
    void run();
    void stop();
    /// Something changed that may be worth a cycle. From any thread.
    void wake();

    /// Counters for the status message. From any thread.
    double samples_per_second() const { return samples_per_second_; }

    /// One pass over all sessions; true when something was rendered. `run` is this in a loop; tests call it directly.
    bool cycle(Sessions const& sessions, WallTime now);

private:
    void pose_scene(SceneTime time);
    NumberedView resolve_camera(CameraUpdate const& camera) const;
    /// What is kept of a viewer from batch to batch.
    struct Viewer {
        AdaptiveRefresh refresh;
        ShapeFeed shapes;
        QualityChoice choice;
        LossyPlaces lossy;
    };

    bool render_session(Session& session, Viewer& viewer, SceneTime time, double share);
    void describe_shapes(Viewer& viewer, std::vector<std::uint8_t> const& needed, ViewState const& state);
    bool send_exactly(Session& session, Viewer& viewer, SessionInput const& input, ViewState const& state);
    void render_plan(std::span<Tile const> tiles, std::span<Probe const> probes, ViewState const& state);
    void send_batch(Session& session, ViewState const& state);
    void finish_encoding();
    void forget_ended(Sessions const& sessions);

    Scene const& scene_;
    std::vector<Index> const clips_;
    bool const animated_;
    RenderScene& render_scene_;
    SceneClock const& clock_;
    LoopOptions const options_;
    Events const events_;

    ScenePose pose_;
    std::map<std::uint64_t, Viewer> viewers_; ///< by session
    RenderRate rate_;
    double plan_seconds_ = 0; ///< what planning a cycle takes
    ProbeRenderer probes_;
    tbb::enumerable_thread_specific<Framelet> fresh_;
    std::vector<Framelet> rendered_pool_; ///< as many as a batch ever had: making room for them costs time
    std::vector<DisplayFramelet> display_pool_;
    std::span<Framelet> rendered_; ///< of the last plan; without radiance, which would crowd the caches for nothing
    std::span<DisplayFramelet> display_;
    std::vector<std::uint8_t> needed_; ///< whether the viewer gets it, of each
    std::vector<std::uint8_t> qualities_; ///< of those that are sent; empty: all are exact
    std::vector<FrameletShape> shapes_; ///< of those that are sent
    std::vector<Tile> lossy_tiles_; ///< scratch
    bool waits_for_room_ = false; ///< a viewer, in this cycle
    std::vector<BodyTrack> tracks_;

    struct Encoding;
    std::unique_ptr<Encoding> encoding_;

    std::mutex mutex_;
    std::condition_variable woken_;
    bool wake_ = false;
    bool stop_ = false;
    std::atomic<double> samples_per_second_ = 0;
};

} // namespace framelet
