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
    if (follower_) {
        follower_->request(request);
        return;
    }
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
    set(requests_.take(now), now);
}

void ServedClock::set(ClockRequest const& request, WallTime when) {
    clock_.apply(request, when);
    changed_();
}

void ServedClock::follow(ConnectionOptions const& leader) {
    follower_ = std::make_unique<ClockFollower>(leader, [this](ClockState const& told, bool takes_requests) {
        auto const heard = std::chrono::steady_clock::now();
        boost::asio::post(io_, [this, told, takes_requests, heard] { take(told, takes_requests, heard); });
    });
}

void ServedClock::take(ClockState const& told, bool takes_requests, WallTime heard) {
    bool const is_news = std::exchange(leader_takes_requests_, takes_requests) != takes_requests;
    ClockState const mine = clock_.state(heard);
    if (told.playing != mine.playing || told.speed != mine.speed ||
        std::abs(told.time - mine.time) > ClockFollower::exact_enough) {
        set({ClockRequest::time | ClockRequest::playing | ClockRequest::speed, told}, heard);
    } else if (is_news) {
        control_changed_();
    }
}

void ServedClock::stop() {
    timer_.cancel();
    follower_.reset();
}

} // namespace framelet
