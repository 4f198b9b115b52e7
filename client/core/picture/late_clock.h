// The moment of the scene that is shown by a viewer that lets the scene be a little late so that it moves smoothly. In:
// readings of the scene's clock. Out: scene time.
#pragma once

#include <deque>

#include "common/clock_state.h"

namespace framelet {

/// The scene's clock as it stood a fixed time ago, whatever it did since.
class LateClock {
public:
    /// `lag_seconds` >= 0, of the viewer's own clock.
    explicit LateClock(double lag_seconds) : lag_seconds_(lag_seconds) {}

    /// Notes what the scene's clock says now and returns what it said a lag ago: interpolated between the readings
    /// before and after that, the first reading where none is that old. `now_seconds` does not go back.
    SceneTime read(double now_seconds, SceneTime scene_time);

private:
    struct Reading {
        double seconds = 0;
        SceneTime scene_time = 0;
    };
    double lag_seconds_;
    std::deque<Reading> readings_; ///< the newest one that is older than the lag, and all later ones
};

} // namespace framelet
