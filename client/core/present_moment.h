// The moment that a viewer shows, as camera files have it.
#pragma once

#include <algorithm>

#include "client/core/camera/camera_path.h"
#include "client/core/client_core.h"

namespace framelet {

inline CameraMoment present_moment(ClientCore const& core, float exposure_ev) {
    CameraMoment out;
    if (core.welcome().animation_duration > 0) {
        ClockState const clock = core.clock();
        out.scene_time = std::max(clock.time - core.statistics().lag_seconds, 0.0);
        out.paused = !clock.playing;
    }
    out.exposure_ev = exposure_ev;
    return out;
}

} // namespace framelet
