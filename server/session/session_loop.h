// The server's loop: for every viewer, newest camera and scene time -> tile selection -> rendering, display values ->
// what was learnt -> quality, shapes -> encoding -> socket. Encoding and sending of one batch overlap the rendering of
// the next; with many threads all that follows the rendering does, and the next batch is planned before that is learnt.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "server/schedule/render_rate.h"
#include "server/session/batch_work.h"
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

    /// What the loop asks of its server, on any of its threads.
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
    SharedScene shared() const { return {scene_, clips_, render_scene_}; }
    bool render_session(Session& session, ViewerState& viewer, SceneTime time, double share);
    void plan(Session& session, ViewerState& viewer, SessionInput const& input, ViewState const& state, double share,
              BatchOrder& order);
    bool send_exactly(Session& session, ViewerState& viewer, SessionInput const& input, ViewState const& state);
    void start_finishing();
    void wait_for_finishing();
    /// Waits for all that was rendered to be sent; true where some of it had not been learnt.
    bool finish_rendered();
    void drop_rendered(Session const& session);
    void forget_ended(Sessions const& sessions);

    Scene const& scene_;
    std::vector<Index> const clips_;
    bool const animated_;
    RenderScene& render_scene_;
    SceneClock const& clock_;
    LoopOptions const options_;
    Events const events_;

    ScenePose pose_;
    std::map<std::uint64_t, ViewerState> viewers_; ///< by session
    RenderRate rate_;
    double plan_seconds_ = 0; ///< what planning a cycle takes
    bool waits_for_room_ = false; ///< a viewer, in this cycle

    struct Pipeline;
    std::unique_ptr<Pipeline> pipeline_;

    std::mutex mutex_;
    std::condition_variable woken_;
    bool wake_ = false;
    bool stop_ = false;
    std::atomic<double> samples_per_second_ = 0;
};

} // namespace framelet
