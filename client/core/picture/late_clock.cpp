#include "client/core/picture/late_clock.h"

namespace framelet {

SceneTime LateClock::read(double now_seconds, SceneTime scene_time) {
    readings_.push_back({now_seconds, scene_time});
    double const then = now_seconds - lag_seconds_;
    while (readings_.size() > 1 && readings_[1].seconds <= then) {
        readings_.pop_front();
    }
    Reading const& a = readings_.front();
    if (readings_.size() == 1 || then <= a.seconds) {
        return a.scene_time;
    }
    Reading const& b = readings_[1]; // later than `then`, so later than a
    return a.scene_time + (then - a.seconds) / (b.seconds - a.seconds) * (b.scene_time - a.scene_time);
}

} // namespace framelet
