// Serves one viewer, as a state machine without sockets, threads or clocks: what came in -> what is rendered -> bytes.
// In: events in their order, turns with their times, the scene. Out: encoded batches. The same calls in the same order
// give the same bytes, whoever makes them: the server's loop, the evaluation, a replay.
//
// A turn is `plan`, and where that says so `render`, `learn`, `encode`, in this order. The next turn's `plan` and
// `render` may come before this turn's `learn`; `encode` and, from its own thread, `learn` may run beside the next
// turn's `render`, nothing else beside anything.
#pragma once

#include <cstdint>

#include "server/stream/posed_scene.h"
#include "server/stream/stream_event.h"

namespace framelet {

class AdaptiveRefresh;

/// Values that a stream is given when it is its turn.
struct Turn {
    double now = 0; ///< seconds, the clock of the events
    SceneTime present = 0; ///< what the scene's clock says
    double clock_speed = 0; ///< of the scene's clock, scene seconds a second; 0 while it is paused
    double samples_per_second = 0; ///< that the renderer has for this viewer
    double plan_seconds = 0; ///< what planning a cycle takes, for all viewers that share the time
    /// What it takes to begin another moment, for all viewers likewise: to move the scene, and to tell of its bodies.
    double pose_seconds = 0;
    std::uint64_t busy_framelets = 1; ///< so many of a batch give work to all who render it, workers too
    bool operator==(Turn const&) const = default;
};

/// The next step of a turn.
enum class Step : std::uint8_t {
    nothing, ///< there is nothing to do until something changes
    wait, ///< the link is full, the viewer owes answers, or it has all of a moment: time alone may change that
    finish, ///< what was rendered is to be learnt first
    render, ///< the scene is to be posed for `moment()`; then `render`, `learn` and `encode`
};

/// Figures of a turn's work, for whoever charges or records it.
struct TurnFigures {
    bool is_new_cycle = false; ///< what is worth rendering was worked out anew
    std::uint64_t regions = 0; ///< regions that a new plan goes over
    std::uint64_t framelets = 0; ///< framelets that are rendered
    std::uint64_t rays = 0; ///< through samples
    std::uint64_t probes = 0;
    std::uint64_t segments = 0; ///< rays of samples, with their shadow and mirror rays, and visibility rays
    std::uint64_t probe_segments = 0; ///< rays of probes, likewise
    std::uint64_t learnt_samples = 0; ///< that were learnt from
    std::uint64_t exact_samples = 0, lossy_samples = 0, shaped_samples = 0; ///< that are sent
};

class ViewerStream {
public:
    virtual ~ViewerStream() = default;

    virtual void take(StreamEvent const& event) = 0;
    /// Plans the turn. The scene is asked where its cameras are, and left posed as it is.
    virtual Step plan(Turn const& turn, PosedScene& scene) = 0;
    /// The scene time of what was planned.
    virtual SceneTime moment() const = 0;
    /// Renders what was planned, in parallel on the calling TBB arena.
    virtual void render(PosedScene const& scene) = 0;
    /// Learns what was rendered and not learnt yet. False where nothing is to be encoded.
    virtual bool learn(PosedScene& scene) = 0;
    /// Encodes what was learnt last. Only where `learn` returned true.
    virtual EncodedBatch encode() = 0;

    /// True when, as far as is learnt, the viewer will have the complete picture of what is to be seen.
    virtual bool is_complete() const = 0;
    /// The newest batch that was learnt; 0: none.
    virtual std::uint64_t last_batch() const = 0;
    /// Figures of the turn that was planned, and of the one that was learnt last.
    virtual TurnFigures const& planned_figures() const = 0;
    virtual TurnFigures const& learnt_figures() const = 0;
    /// The scheduler, to look at what it decides; null for streams that have none.
    virtual AdaptiveRefresh const* scheduler() const { return nullptr; }
};

} // namespace framelet
