// The server's last Status, and the scene's clock as it goes on from there. In: its messages, requests for the clock,
// and when they came. Out: status, and clock at any time. A value.
#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

#include "common/clock_state.h"
#include "protocol/messages/message.h"

namespace framelet {

class ServerState {
public:
    using Time = std::chrono::steady_clock::time_point;

    /// True once the server has said anything.
    bool has_begun() const { return since_.has_value(); }
    /// A session has been opened.
    void begin(Welcome const& welcome, Time now) {
        status_ = {};
        status_.clock = welcome.clock;
        status_.controls = welcome.controls;
        since_ = now;
    }
    void note(Status const& status, Time now) {
        status_ = status;
        since_ = now;
    }
    /// The session was interrupted: the clock stands.
    void stop(Time now) {
        status_.clock = clock_at(now);
        status_.clock.playing = false;
        status_.converged = false;
    }
    /// Sets the clock as if the request were granted.
    void ask_clock(ClockRequest const& request, Time now) {
        ClockState& clock = status_.clock;
        clock = clock_at(now);
        since_ = now;
        clock.time = (request.set & ClockRequest::time) != 0 ? request.state.time : clock.time;
        clock.playing = (request.set & ClockRequest::playing) != 0 ? request.state.playing : clock.playing;
        clock.speed = (request.set & ClockRequest::speed) != 0 ? request.state.speed : clock.speed;
        status_.converged = false;
    }

    /// The last Status, in which requests for the clock count as granted; `clock_at` has the clock's present time.
    Status const& status() const { return status_; }
    ClockState clock_at(Time time) const {
        ClockState out = status_.clock;
        if (out.playing) {
            double const elapsed = std::chrono::duration<double>(time - since_.value_or(time)).count();
            out.time = std::clamp(out.time + elapsed * static_cast<double>(out.speed), 0.0, max_scene_time);
        }
        return out;
    }

private:
    Status status_;
    std::optional<Time> since_; ///< when the clock had its time; nothing: the server has said nothing
};

} // namespace framelet
