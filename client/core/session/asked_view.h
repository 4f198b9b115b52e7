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

    /// True once the user has asked for a view.
    bool exists() const { return newest_.view.number > 0; }
    bool equals(Camera const& camera, Viewport viewport, int scene_camera) const {
        return has_viewport(viewport) && newest_.view.camera == camera && newest_.scene_camera == scene_camera;
    }
    /// True where the newest view has this viewport, so that what is held of it can be shown.
    bool has_viewport(Viewport viewport) const { return exists() && newest_.view.viewport == viewport; }
    void set(Camera const& camera, Viewport viewport, int scene_camera, Time now) {
        std::uint64_t const number = newest_.view.number + 1;
        std::uint64_t const held_since = has_viewport(viewport) ? newest_.view.held_since : number;
        newest_ = {{number, camera, viewport, held_since}, scene_camera};
        is_unsent_ = true;
        times_.note_set(number, now);
    }

    /// The newest view; its number is 0 where there is none.
    NumberedView const& view() const { return newest_.view; }
    int scene_camera() const { return newest_.scene_camera; }
    /// True where the batch belongs to what is held now: of this viewport, and since it was changed to last.
    bool wants(Batch const& batch) const {
        return batch.view.held_since == newest_.view.held_since && batch.view.viewport == newest_.view.viewport;
    }

    /// True while the newest view waits to be sent; a newer one replaces it.
    bool is_unsent() const { return is_unsent_; }
    CameraUpdate const& send(Time now) {
        is_unsent_ = false;
        first_sent_ = first_sent_.value_or(now);
        times_.note_sent(newest_.view.number, now);
        return newest_;
    }
    /// Another session begins, which knows nothing of what was sent.
    void begin_session() {
        is_unsent_ = exists();
        times_.forget_sent();
    }
    /// The time when the first view of all was sent.
    std::optional<Time> first_sent() const { return first_sent_; }

    /// Seconds since this view was set or sent, as CameraTimes has them.
    std::optional<double> since_set(std::uint64_t number, Time now) { return times_.since_set(number, now); }
    std::optional<double> since_sent(std::uint64_t number, Time now) { return times_.since_sent(number, now); }

private:
    CameraUpdate newest_; ///< sent or not
    bool is_unsent_ = false;
    std::optional<Time> first_sent_;
    CameraTimes times_;
};

} // namespace framelet
