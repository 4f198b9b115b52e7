// The server's loop: for every viewer, what has come -> its stream's turn -> rendering -> learning -> encoding ->
// socket. Encoding and sending of one batch overlap the rendering of the next; with many threads all that follows the
// rendering does, and the next batch is planned before that is learnt.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "server/sampling/plan/render_rate.h"
#include "server/session/clock/scene_clock.h"
#include "server/session/session.h"
#include "server/stream/framelet_stream.h"

namespace framelet {

class EventLog;

struct LoopOptions {
    StreamOptions stream;
    EventLog* event_log = nullptr; ///< what comes to the streams, to be replayed; must outlive the loop; null: none
    /// Makes a viewer's stream; empty: a `FrameletStream`.
    std::function<std::unique_ptr<ViewerStream>(StreamOptions const&, std::uint32_t codings)> make_stream;
};

class SessionLoop {
public:
    using Sessions = std::vector<std::shared_ptr<Session>>;

    /// Callbacks by which the loop asks its server, on any of its threads.
    struct Events {
        std::function<Sessions()> open_sessions;
        /// Called when a session's picture is complete, or no longer.
        std::function<void()> convergence_changed;
    };

    /// Scene and clock must outlive the loop.
    SessionLoop(PosedScene& scene, SceneClock const& clock, LoopOptions options, Events events);
    ~SessionLoop();

    /// Serves until `stop`; on the calling thread, with the worker threads of its TBB arena. None of these goes on
    /// after that.
    void run();
    /// Ends `run`. May be called from any thread.
    void stop();
    /// Tells the loop that something changed that may be worth a turn. May be called from any thread.
    void wake();

    /// Rays a second that it would render with all its time, as learnt, for the status message. May be called from any
    /// thread.
    double samples_per_second() const { return samples_per_second_; }
    /// How many rays have been rendered for framelets since the loop's beginning, and the seconds in which there was
    /// something to do. May be called from any thread.
    double rays() const { return rays_; }
    double busy_seconds() const { return busy_seconds_; }
    /// False while there is no memory for the scene. It is built again as soon as there is some.
    bool has_scene() const { return has_scene_; }

private:
    struct Viewer;
    struct Pipeline;

    void serve_once();
    bool learn_light();
    bool pose_scene(SceneTime time);
    void try_for_scene(WallTime now);
    bool give_turns(Sessions const& sessions, WallTime now);
    bool give_turn(std::shared_ptr<Session> const& session, Viewer& viewer, WallTime round_began);
    std::size_t sharers(Viewer const& served) const;
    Viewer& viewer_of(std::shared_ptr<Session> const& session);
    std::unique_ptr<Viewer> new_viewer(std::shared_ptr<Session> const& session) const;
    std::unique_ptr<Viewer> take_up(Session& session, std::shared_ptr<Session> const& earlier);
    void note_rate(TurnFigures const& figures, double seconds, std::optional<double> posing);
    void start_finishing();
    void finish_one(bool learns);
    void wait_for_finishing();
    bool finish_rendered();
    void drop_rendered(Session const& session);
    void forget_ended();

    PosedScene& scene_;
    SceneClock const& clock_;
    LoopOptions const options_;
    Events const events_;

    std::map<std::uint64_t, std::unique_ptr<Viewer>> viewers_; ///< by session, parked ones too
    RenderRate rate_;
    struct {
        double samples = 0, seconds = 0;
    } round_; ///< what was rendered since the rate was learnt last, and how long that took
    double plan_seconds_ = 0; ///< how long planning a cycle takes, about
    double pose_seconds_ = 0; ///< how long it takes to begin a moment, as `Turn::pose_seconds`
    bool waits_for_room_ = false; ///< a viewer's stream waits, in this round
    bool has_learnt_light_ = false; ///< once there was no more to learn
    std::unique_ptr<Pipeline> pipeline_;

    std::mutex mutex_;
    std::condition_variable woken_;
    bool wake_ = false;
    bool stop_ = false;
    std::atomic<bool> has_scene_ = true;
    WallTime tried_for_scene_; ///< when it was last tried to get it back, though nobody had a turn
    std::atomic<double> samples_per_second_ = 0;
    std::atomic<double> rays_ = 0, busy_seconds_ = 0; ///< written by the loop's thread alone
};

} // namespace framelet
