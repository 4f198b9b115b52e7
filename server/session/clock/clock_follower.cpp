#include "server/session/clock/clock_follower.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

#include <spdlog/spdlog.h>

#include "common/error.h"
#include "protocol/connection/server_connection.h"

namespace framelet {
namespace {

/// Until it is tried again: at a server that is gone, and at one that refuses, which takes each time for a guess.
constexpr std::chrono::seconds pause{1}, pause_after_refusal{30};

ConnectionOptions options_for(ConnectionOptions options) {
    options.clock_only = true;
    options.connect_seconds = 4; // longer than a server lets those wait whose neighbours guess tokens
    return options;
}

} // namespace

struct ClockFollower::Impl {
    ConnectionOptions const options;
    Take const take;
    std::mutex mutex;
    std::condition_variable_any news;
    std::unique_ptr<ServerConnection> connection; ///< null: there is none
    bool is_lost = false; ///< the connection has ended
    std::string last_complaint; ///< of the thread alone
    std::jthread thread;

    Impl(ConnectionOptions const& leader, Take to_take) : options(options_for(leader)), take(std::move(to_take)) {
        thread = std::jthread([this](std::stop_token const& stop) { run(stop); });
    }

    void run(std::stop_token const& stop) {
        while (!stop.stop_requested()) {
            auto const until_next = hear(stop);
            std::unique_lock lock(mutex);
            news.wait_for(lock, stop, until_next, [] { return false; });
        }
    }

    /// Connects, and hears the clock until the connection is lost. Returns how long to wait before the next time.
    std::chrono::seconds hear(std::stop_token const& stop) {
        try {
            is_lost = false;
            auto made = std::make_unique<ServerConnection>(options, handlers());
            spdlog::info("the clock of {} is followed", options.server.text());
            last_complaint.clear();
            take(made->welcome().clock, made->welcome().controls);
            std::unique_lock lock(mutex);
            connection = std::move(made);
            news.wait(lock, stop, [this] { return is_lost; });
            auto const ended = std::exchange(connection, nullptr);
            lock.unlock(); // its handlers may wait for that
            take(std::nullopt, false);
            return pause;
        } catch (ConnectionRefusal const& refusal) {
            complain(refusal.what());
            return pause_after_refusal;
        } catch (std::exception const& error) { // whatever it is, the scene can be served without that clock
            complain(error.what());
            return pause;
        }
    }

    ServerConnection::Handlers handlers() {
        ServerConnection::Handlers out;
        out.on_message = [this](Message const& message) {
            if (auto const* const status = std::get_if<Status>(&message)) {
                take(status->clock, status->controls);
            }
        };
        out.on_lost = [this](std::string const& reason) {
            spdlog::warn("the clock of --clock-from is not heard, and goes on by itself: {}", reason);
            std::scoped_lock const lock(mutex);
            is_lost = true;
            news.notify_all();
        };
        out.on_sent = [] {};
        return out;
    }

    /// Says why there is no connection, once.
    void complain(char const* reason) noexcept {
        try {
            if (std::exchange(last_complaint, reason) != reason) {
                spdlog::warn("the clock of --clock-from is not followed yet: {}", reason);
            }
        } catch (std::exception const&) { // memory is missing for the words
        }
    }
};

ClockFollower::ClockFollower(ConnectionOptions const& leader, Take take)
    : impl_(std::make_unique<Impl>(leader, std::move(take))) {}

ClockFollower::~ClockFollower() {
    impl_->thread.request_stop();
    impl_->thread.join();
}

void ClockFollower::request(ClockRequest const& request) {
    std::scoped_lock const lock(impl_->mutex);
    if (impl_->connection) {
        impl_->connection->send(request);
    }
}

} // namespace framelet
