#include "server/stream/moment_choice.h"

#include <algorithm>
#include <cmath>

namespace framelet {

double moment_seconds(double samples_per_pixel_and_second) {
    constexpr double at_one_sample = 0.25; // seconds, by measurements with 1 to 20 samples
    double const wanted =
        std::clamp(at_one_sample / std::sqrt(samples_per_pixel_and_second), least_moment_seconds, most_moment_seconds);
    return std::ldexp(least_moment_seconds, static_cast<int>(std::lround(std::log2(wanted / least_moment_seconds))));
}

double worth_posing(double seconds, double pose_seconds) {
    constexpr double least_share = 4, most_seconds = 3.2;
    while (seconds < least_share * pose_seconds && seconds < most_seconds) {
        seconds *= 2;
    }
    return seconds;
}

void MomentChoice::begin(HeldMoment const& moment) {
    if (held_ && completed_ && *completed_ - held_->begun < 0.5 * held_->seconds) {
        standing_seconds_ = std::max(0.5 * standing_seconds_, least_standing_seconds);
    } else if (!completed_) {
        standing_seconds_ = least_moment_seconds;
    }
    held_ = moment;
    completed_.reset();
}

void MomentChoice::note_complete(double now) {
    if (!completed_) {
        completed_ = now;
    }
}

bool MomentChoice::goes_on(ViewState const& present, double now) const {
    if (!held_) {
        return false;
    }
    ViewState const& held = held_->state;
    return std::floor(now / held_->seconds) == std::floor(held_->begun / held_->seconds) &&
           held.view.viewport == present.view.viewport &&
           held.view.camera.projection == present.view.camera.projection && held.transform == present.transform;
}

/// True where what is held of the first shows about the second: not after the scene's clock was set to another time,
/// nor at another size.
bool MomentChoice::is_near(ViewState const& one, ViewState const& other) {
    constexpr SceneTime near = 0.5; // seconds
    return std::abs(one.scene_time - other.scene_time) < near && one.view.viewport == other.view.viewport;
}

bool MomentChoice::observe(ViewState const& present, double now) {
    if (!last_ || !same_picture(*last_, present)) {
        changed_ = now;
        is_stop_ = is_stop_ && last_ && is_near(*last_, present);
    }
    last_ = present;
    bool const is_complete = held_ && completed_ && held_->begun >= changed_;
    double const still = is_stop_ && !is_complete ? stop_seconds : rest_seconds;
    if (now - changed_ > still) {
        held_.reset();
        is_stop_ = false;
        return false;
    }
    return !goes_on(present, now);
}

} // namespace framelet
