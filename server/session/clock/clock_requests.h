// Collects what viewers ask of the shared clock, however often: the newest of each field, at most some 60 times a
// second. In: requests as they come. Out: one request that says the same as all of them, and when to apply it.
#pragma once

#include <chrono>
#include <utility>

#include "protocol/messages/message.h"
#include "server/session/limits/wall_time.h"

namespace framelet {

class ClockRequests {
public:
    /// Least time from one application to the next. Each costs every viewer a Status and a new look at its picture.
    static constexpr std::chrono::microseconds interval{16667};

    /// True when nothing waited before: somebody has to `take` it when it is `due`.
    bool add(ClockRequest const& request) {
        bool const is_first = waiting_.set == 0;
        ClockState& state = waiting_.state;
        state.time = (request.set & ClockRequest::time) != 0 ? request.state.time : state.time;
        state.playing = (request.set & ClockRequest::playing) != 0 ? request.state.playing : state.playing;
        state.speed = (request.set & ClockRequest::speed) != 0 ? request.state.speed : state.speed;
        waiting_.set |= request.set;
        return is_first && waiting_.set != 0;
    }

    /// The time at which what waits is to be applied; one that is past: at once.
    WallTime due() const { return taken_ + interval; }

    /// Takes all that has come since the last time, as one request.
    ClockRequest take(WallTime now) {
        taken_ = now;
        return std::exchange(waiting_, {});
    }

private:
    ClockRequest waiting_; ///< sets nothing: none
    WallTime taken_{};
};

} // namespace framelet
