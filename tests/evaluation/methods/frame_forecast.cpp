#include "tests/evaluation/methods/frame_forecast.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/quaternion.hpp>

namespace framelet::bench {
namespace {

/// Weight of the newest measurement in a running mean.
constexpr double newest_share = 0.5;
/// Seconds for which a hand is taken to go on as it did: beyond that it more likely has turned back.
constexpr double longest_extrapolation = 0.2;
/// Differences of cameras up to this are those of rounding.
constexpr float rounding = 1e-6f;

double mean_of(double before, double newest) {
    return before > 0 ? before + newest_share * (newest - before) : newest;
}

Vec3 rotation_vector(Quat q) {
    q = q.w < 0 ? -q : q;
    Vec3 const axis(q.x, q.y, q.z);
    float const sine = glm::length(axis);
    return sine > 0 ? axis * (2 * std::atan2(sine, q.w) / sine) : Vec3(0);
}

Quat rotation_by(Vec3 vector) {
    float const angle = glm::length(vector);
    return angle > 0 ? glm::angleAxis(angle, vector / angle) : Quat(1, 0, 0, 0);
}

} // namespace

FrameForecast::FrameForecast(MethodSetup const& setup, double viewer_seconds)
    : delay_(setup.delay_seconds), viewer_seconds_(viewer_seconds) {}

FrameMoment FrameForecast::moment(StepInput const& input) {
    if (input.clock_set && !clock_.empty()) { // as if the clock had been so all along
        SceneTime const jump = input.time - clock_.back().time - (input.now - clock_.back().now);
        std::ranges::for_each(clock_, [jump](Tick& tick) { tick.time += jump; });
    }
    bool const runs = !clock_.empty() && input.time > clock_.back().time;
    clock_.push_back({input.now, input.time});
    while (clock_.size() > 2 && clock_[1].now <= input.now - delay_) {
        clock_.pop_front();
    }
    SceneTime const time = runs ? input.time + lead() : input.time;
    return {camera(input, time), time};
}

SceneTime FrameForecast::time_at(double when) const {
    for (std::size_t i = 1; i < clock_.size(); ++i) {
        Tick const& before = clock_[i - 1];
        Tick const& after = clock_[i];
        if (when <= after.now) {
            double const part = std::clamp((when - before.now) / std::max(after.now - before.now, 1e-9), 0.0, 1.0);
            return before.time + part * (after.time - before.time);
        }
    }
    return clock_.back().time;
}

Camera FrameForecast::camera(StepInput const& input, SceneTime time) {
    Camera const& seen = input.view.camera;
    Camera const base = own_camera_at(input.scene, time_at(input.now - delay_));
    Quat const back = glm::conjugate(base.orientation);
    Offset const offset{back * (seen.position - base.position), glm::normalize(back * seen.orientation)};
    double const since = input.now - offset_now_;
    if (has_offset_ && since > 0) {
        Vec3 const shift = offset.position - offset_.position;
        Vec3 const turn = rotation_vector(offset.orientation * glm::conjugate(offset_.orientation));
        moves_ = glm::length(shift) > rounding * (1 + glm::length(offset.position)) || glm::length(turn) > rounding;
        velocity_ = {shift / static_cast<float>(since), rotation_by(turn / static_cast<float>(since))};
    }
    offset_ = offset;
    offset_now_ = input.now;
    has_offset_ = true;

    Camera result = own_camera_at(input.scene, time);
    if (!moves_ && result == base) {
        return seen;
    }
    result.projection = seen.projection;
    result.vertical_extent = seen.vertical_extent;
    Offset ahead = offset;
    if (moves_) {
        auto const seconds = static_cast<float>(std::min(delay_ + lead(), longest_extrapolation));
        ahead.position += seconds * velocity_.position;
        ahead.orientation = rotation_by(seconds * rotation_vector(velocity_.orientation)) * offset.orientation;
    } else if (glm::length(ahead.position) < rounding && glm::length(rotation_vector(ahead.orientation)) < rounding) {
        return result;
    }
    result.position += result.orientation * ahead.position;
    result.orientation = glm::normalize(result.orientation * ahead.orientation);
    return result;
}

void FrameForecast::begin(double now, bool typical) {
    if (typical && last_.typical && now > last_.begun) {
        period_ = mean_of(period_, now - last_.begun);
    }
    last_ = {now, typical};
    unanswered_.push_back(last_);
}

void FrameForecast::sent(double now) {
    if (period_ == 0) {
        period_ = now - last_.begun; // before a second frame nothing better is known
    }
}

void FrameForecast::answered(double arrived) {
    Frame const frame = unanswered_.front();
    unanswered_.pop_front();
    if (frame.typical) {
        lead_ = mean_of(lead_, arrived - frame.begun + viewer_seconds_);
    }
}

} // namespace framelet::bench
