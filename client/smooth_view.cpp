#include "client/smooth_view.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/quaternion.hpp>

#include "common/error.h"

namespace framelet {

namespace {

/// About 20 degrees, as the cosine of half the angle.
constexpr float least_likeness = 0.985f;

bool has_cut(Camera const& before, Camera const& after) {
    return before.projection != after.projection ||
           std::abs(glm::dot(before.orientation, after.orientation)) < least_likeness;
}

Camera between(Camera const& before, Camera const& after, float share) {
    Camera out = before;
    out.position = glm::mix(before.position, after.position, share);
    out.orientation = glm::normalize(glm::slerp(before.orientation, after.orientation, share));
    out.vertical_extent = glm::mix(before.vertical_extent, after.vertical_extent, share);
    return out;
}

} // namespace

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

void CameraTrack::add(SceneTime time, Camera const& camera) {
    if (!keys_.empty() && time < keys_.back().time) {
        keys_.clear();
    }
    if (!keys_.empty() && time == keys_.back().time) {
        keys_.back().camera = camera;
        return;
    }
    keys_.push_back({time, camera});
    if (keys_.size() > most_keys) {
        keys_.pop_front();
    }
}

Camera CameraTrack::at(SceneTime time) const {
    FRAMELET_CHECK(!keys_.empty());
    auto const after = std::ranges::upper_bound(keys_, time, {}, &Key::time);
    if (after == keys_.begin()) {
        return keys_.front().camera;
    }
    Key const& before = *(after - 1);
    if (after == keys_.end() || before.camera == after->camera || has_cut(before.camera, after->camera)) {
        return before.camera;
    }
    return between(before.camera, after->camera,
                   static_cast<float>((time - before.time) / (after->time - before.time)));
}

} // namespace framelet
