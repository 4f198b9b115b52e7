// The scene clock that all viewers share. In: wall time and requests; out: what time it is in the scene.
#pragma once

#include <mutex>

#include "common/clock_state.h"
#include "protocol/messages/message.h"
#include "server/session/limits/wall_time.h"

namespace framelet {

/// Runs at `speed` scene seconds per wall second while it plays, from 0 to `max_scene_time`. May be used from any
/// thread.
class SceneClock {
public:
    /// The clock stands at 0 at `now`, and goes on from there if it plays.
    SceneClock(bool playing, WallTime now);

    /// State of the clock at a time. What was set last begins when it was set, for those who ask of a time before that,
    /// too.
    ClockState state(WallTime now) const;
    /// Takes the fields that the request sets.
    void apply(ClockRequest const& request, WallTime now);

private:
    ClockState advanced(WallTime now) const;

    mutable std::mutex mutex_;
    ClockState at_mark_; ///< what it stood at ...
    WallTime mark_; ///< ... at this moment
};

} // namespace framelet
