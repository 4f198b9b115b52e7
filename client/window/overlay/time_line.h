// The scene's clock, and the round of the animation that it is in: the longest clip begins anew at its end, the clock
// goes on, since other clips are not where they were then. In: clock, length of that clip. Out: when the round begins
// and ends.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "common/clock_state.h"

namespace framelet {

struct TimeLine {
    ClockState clock;
    double duration = 0; ///< of the longest clip, seconds; 0: nothing moves
    std::string fixed_because{}; ///< why the clock cannot be set from here; empty: it can
    float exposure_ev = 0; ///< of this viewer

    bool operator==(TimeLine const&) const = default;

    /// When the longest clip began anew, seconds of the clock; 0 where nothing moves.
    SceneTime round_begin() const { return duration > 0 ? clock.time - std::fmod(clock.time, duration) : 0; }
    /// When it does so next.
    SceneTime round_end() const { return std::min(round_begin() + duration, max_scene_time); }
};

} // namespace framelet
