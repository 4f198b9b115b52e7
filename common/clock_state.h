// The state of the scene clock: what it is, and what a viewer may ask for. The clock is shared by all viewers of a
// server.
#pragma once

#include "common/framelet/framelet.h"

namespace framelet {

/// The last moment of a scene, seconds, about 30 years: doubles still tell microseconds apart there, and keys of tracks
/// can be counted.
inline constexpr SceneTime max_scene_time = 1e9;

struct ClockState {
    SceneTime time = 0; ///< seconds, [0, max_scene_time]
    bool playing = false;
    float speed = 1; ///< scene seconds per wall second, [-16, 16]

    bool operator==(ClockState const&) const = default;
};

inline constexpr float max_clock_speed = 16;

} // namespace framelet
