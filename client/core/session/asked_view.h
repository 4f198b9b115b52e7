// The view that the user asks for, and what of it the server knows. In: views as they are set, when they are sent. Out:
// the newest, and the one to send. A value.
#pragma once

#include <cstdint>
#include <optional>

#include "client/core/camera/camera_times.h"
#include "common/framelet/framelet.h"
#include "protocol/messages/message.h"

namespace framelet {

class AskedView {
public:
    using Time = CameraTimes::Time;

    /// Whether there is one yet.
    bool exists() const { return newest_.view.number > 0; }
    bool equals(Camera const& camera, Viewport viewport, int scene_camera) const {
        return has_viewport(viewport) && newest_.view.camera == camera && newest_.scene_camera == scene_camera;
    }
    /// Whether what is held of it can be shown in such a picture.
    bool has_viewport(Viewport viewport) const { return exists() && newest_.view.viewport == viewport; }
    void set(Camera const& camera, Viewport viewport, int scene_camera, Time now) {
        std::uint64_t const number = newest_.view.number + 1;
        std::uint64_t const held_since = has_viewport(viewport) ? newest_.view.held_since : number;
        newest_ = {{number, camera, viewport, held_since}, scene_camera};
        is_unsent_ = true;
        times_.note_set(number, now);
    }

    /// With number 0 where there is none.
    NumberedView const& view() const { return newest_.view; }
    int scene_camera() const { return newest_.scene_camera; }
    /// Whether the batch is for a picture of this size.
    bool wants(Batch const& batch) const {
        return batch.view.held_since == newest_.view.held_since && batch.view.viewport == newest_.view.viewport;
    }

    /// One at most waits: a newer one replaces it.
    bool is_unsent() const { return is_unsent_; }
    CameraUpdate const& send(Time now) {
        is_unsent_ = false;
        first_sent_ = first_sent_.value_or(now);
        times_.note_sent(newest_.view.number, now);
        return newest_;
    }
    /// Another session knows nothing of what was sent.
    void begin_session() {
        is_unsent_ = exists();
        times_.forget_sent();
    }
    /// When the first of all was.
    std::optional<Time> first_sent() const { return first_sent_; }

    /// Seconds, as CameraTimes says.
    std::optional<double> since_set(std::uint64_t number, Time now) { return times_.since_set(number, now); }
    std::optional<double> since_sent(std::uint64_t number, Time now) { return times_.since_sent(number, now); }

private:
    CameraUpdate newest_; ///< sent or not
    bool is_unsent_ = false;
    std::optional<Time> first_sent_;
    CameraTimes times_;
};

} // namespace framelet
