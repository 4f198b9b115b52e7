// What the scene clock stands at, and what a viewer may ask of it. The clock is shared by all viewers of a server.
#pragma once

#include "common/framelet.h"

namespace framelet {

struct ClockState {
    SceneTime time = 0; ///< seconds, >= 0
    bool playing = false;
    float speed = 1; ///< scene seconds per wall second, [-16, 16]

    bool operator==(ClockState const&) const = default;
};

inline constexpr float max_clock_speed = 16;

} // namespace framelet
