#include "server/stream/moment_choice.h"

#include <cmath>

namespace framelet {

bool MomentChoice::goes_on(ViewState const& present, double now) const {
    if (!held_) {
        return false;
    }
    ViewState const& held = held_->state;
    return std::floor(now / seconds_) == std::floor(held_->begun / seconds_) &&
           held.view.viewport == present.view.viewport &&
           held.view.camera.projection == present.view.camera.projection && held.exposure == present.exposure;
}

bool MomentChoice::observe(ViewState const& present, double now, bool viewer_moves_samples) {
    bool const was_resting = now - changed_ > rest_seconds;
    if (!last_ || !same_picture(*last_, present)) {
        changed_ = now;
    }
    bool const rests = now - changed_ > rest_seconds;
    last_ = present;
    if (!viewer_moves_samples || rests) {
        held_.reset();
        return false;
    }
    return was_resting || !goes_on(present, now);
}

} // namespace framelet
