// The scene's clock as a server has it: viewers set it or, where the server follows another one's, that one does. On
// the io thread, but for the clock itself. In: requests, and what the other server says. Out: a clock that goes.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>

#include "protocol/connection/server_address.h"
#include "server/session/clock/clock_follower.h"
#include "server/session/clock/clock_requests.h"
#include "server/session/clock/scene_clock.h"

namespace framelet {

class ServedClock {
public:
    /// `changed` is called when the clock was set, `control_changed` where it may be set from now on, or not any more.
    ServedClock(boost::asio::io_context& io, bool playing, std::function<void()> changed,
                std::function<void()> control_changed);

    /// May be asked on any thread.
    SceneClock const& scene() const { return clock_; }
    /// False where it is another server's clock, which takes no requests from here.
    bool takes_requests() const { return !follower_ || leader_takes_requests_; }
    /// Sets the clock, or has it set by the server that is followed.
    void request(ClockRequest const& request);

    /// Follows this server's clock from now on.
    void follow(ConnectionOptions const& leader);
    /// Ends that; it may take some seconds.
    void unfollow() { follower_.reset(); }
    /// Forgets what waits.
    void stop() { timer_.cancel(); }

private:
    void apply_requests();
    void set(ClockRequest const& request, WallTime when);
    void take(std::optional<ClockState> const& told, bool takes_requests, WallTime heard);
    bool differs(ClockState const& told, WallTime heard);

    boost::asio::io_context& io_;
    boost::asio::steady_timer timer_;
    SceneClock clock_;
    ClockRequests requests_;
    std::function<void()> const changed_, control_changed_;
    bool leader_takes_requests_ = false;
    int late_in_a_row_ = 0; ///< how often the clock that is followed has seemed late
    std::unique_ptr<ClockFollower> follower_; ///< null: the clock is this server's own
};

} // namespace framelet
