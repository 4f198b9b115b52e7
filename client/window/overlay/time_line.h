// The place of the scene's clock in the animation, which begins anew at its end. In: clock, length of the animation.
// Out: a place in it, and the time of the clock that goes with another place.
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

    /// Seconds since the animation began anew, [0, duration); 0 where nothing moves.
    double place() const { return duration > 0 ? std::fmod(clock.time, duration) : 0; }
    /// The clock's time that goes with another place in the same round.
    SceneTime time_at(double other_place) const {
        return std::clamp(clock.time - place() + other_place, 0.0, max_scene_time);
    }
};

} // namespace framelet
