#include "server/session/clock/served_clock.h"

#include <cmath>
#include <new>
#include <utility>

#include <boost/asio/post.hpp>

namespace framelet {

ServedClock::ServedClock(boost::asio::io_context& io, bool playing, std::function<void()> changed,
                         std::function<void()> control_changed)
    : io_(io), timer_(io), clock_(playing, std::chrono::steady_clock::now()), changed_(std::move(changed)),
      control_changed_(std::move(control_changed)) {}

void ServedClock::request(ClockRequest const& request) {
    if (!requests_.add(request)) {
        return;
    }
    try {
        timer_.expires_at(requests_.due());
        timer_.async_wait([this](boost::system::error_code error) {
            if (!error) {
                apply_requests();
            }
        });
    } catch (std::bad_alloc const&) {
        apply_requests(); // nobody would come for them later
    }
}

void ServedClock::apply_requests() {
    auto const now = std::chrono::steady_clock::now();
    ClockRequest const request = requests_.take(now);
    follower_ ? follower_->request(request) : set(request, now);
}

void ServedClock::set(ClockRequest const& request, WallTime when) {
    clock_.apply(request, when);
    changed_();
}

void ServedClock::follow(ConnectionOptions const& leader) {
    follower_ = std::make_unique<ClockFollower>(leader, [this](auto const& told, bool takes_requests) {
        auto const heard = std::chrono::steady_clock::now();
        boost::asio::post(io_, [this, told, takes_requests, heard] { take(told, takes_requests, heard); });
    });
}

void ServedClock::take(std::optional<ClockState> const& told, bool takes_requests, WallTime heard) {
    bool const is_news = std::exchange(leader_takes_requests_, takes_requests) != takes_requests;
    if (told && differs(*told, heard)) {
        set({ClockRequest::time | ClockRequest::playing | ClockRequest::speed, *told}, heard);
    } else if (is_news) {
        control_changed_();
    }
}

/// Whether the clock is to be set for what was heard. What is said takes longer on its way now and then, and seems late
/// then: that counts where it is so every time.
bool ServedClock::differs(ClockState const& told, WallTime heard) {
    constexpr double exact_enough = 0.008, far_off = 0.25; // seconds
    constexpr int every_time = 3;
    ClockState const mine = clock_.state(heard);
    double const ahead = (told.time - mine.time) * (told.speed < 0 ? -1 : 1);
    bool const is_late = told.playing && ahead < -exact_enough && ahead > -far_off;
    late_in_a_row_ = is_late ? late_in_a_row_ + 1 : 0;
    if (told.playing == mine.playing && told.speed == mine.speed &&
        (std::abs(ahead) <= exact_enough || (is_late && late_in_a_row_ < every_time))) {
        return false;
    }
    late_in_a_row_ = 0;
    return true;
}

} // namespace framelet
