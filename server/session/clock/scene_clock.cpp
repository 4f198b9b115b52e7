#include "server/session/clock/scene_clock.h"

#include <algorithm>

namespace framelet {

SceneClock::SceneClock(bool playing, WallTime now) : at_mark_{0, playing, 1}, mark_(now) {}

ClockState SceneClock::state(WallTime now) const {
    std::scoped_lock const lock(mutex_);
    return advanced(now);
}

void SceneClock::apply(ClockRequest const& request, WallTime now) {
    std::scoped_lock const lock(mutex_);
    at_mark_ = advanced(now);
    mark_ = now;
    if (request.set & ClockRequest::time) {
        at_mark_.time = std::clamp(request.state.time, 0.0, max_scene_time);
    }
    if (request.set & ClockRequest::playing) {
        at_mark_.playing = request.state.playing;
    }
    if (request.set & ClockRequest::speed) {
        at_mark_.speed = std::clamp(request.state.speed, -max_clock_speed, max_clock_speed);
    }
}

ClockState SceneClock::advanced(WallTime now) const {
    ClockState state = at_mark_;
    if (state.playing) {
        double const elapsed = std::chrono::duration<double>(std::max(now, mark_) - mark_).count();
        state.time = std::clamp(state.time + static_cast<double>(state.speed) * elapsed, 0.0, max_scene_time);
    }
    return state;
}

} // namespace framelet
