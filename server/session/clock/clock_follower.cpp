#include "server/session/clock/clock_follower.h"

#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>

#include <spdlog/spdlog.h>

#include "common/error.h"
#include "protocol/connection/server_connection.h"

namespace framelet {
namespace {

/// Until it is tried again to connect to a server that is not there.
constexpr std::chrono::seconds pause{1};

ConnectionOptions options_for(ConnectionOptions options) {
    options.clock_only = options.reconnect = true;
    options.connect_seconds = 2; // the end of this server waits for it
    return options;
}

} // namespace

struct ClockFollower::Impl {
    ConnectionOptions const options;
    Take const take;
    std::mutex mutex;
    std::condition_variable_any ends;
    std::unique_ptr<ServerConnection> connection; ///< null: there is none yet
    std::string last_complaint;
    std::jthread thread;

    Impl(ConnectionOptions const& leader, Take to_take) : options(options_for(leader)), take(std::move(to_take)) {
        thread = std::jthread([this](std::stop_token const& stop) { connect(stop); });
    }

    ServerConnection::Handlers handlers() {
        ServerConnection::Handlers out;
        out.on_message = [this](Message const& message) {
            if (auto const* const status = std::get_if<Status>(&message)) {
                take(status->clock, status->controls);
            }
        };
        out.on_lost = [](std::string const& reason) {
            spdlog::warn("the clock of --clock-from is not followed any more: {}", reason);
        };
        out.on_interrupted = [](std::string const& reason) {
            spdlog::warn("the clock of --clock-from is not heard, and goes on by itself: {}", reason);
        };
        out.on_reopened = [this](Welcome const& welcome) {
            spdlog::info("the clock of {} is followed again", options.server.text());
            take(welcome.clock, welcome.controls);
        };
        out.on_sent = [] {};
        return out;
    }

    void connect(std::stop_token const& stop) {
        while (!stop.stop_requested()) {
            try {
                auto made = std::make_unique<ServerConnection>(options, handlers());
                spdlog::info("the clock of {} is followed", options.server.text());
                take(made->welcome().clock, made->welcome().controls);
                std::scoped_lock const lock(mutex);
                connection = std::move(made);
                return;
            } catch (std::exception const& error) { // whatever it is, the scene can be served without that clock
                if (std::exchange(last_complaint, error.what()) != error.what()) {
                    spdlog::warn("the clock of --clock-from is not followed yet: {}", error.what());
                }
            }
            std::unique_lock lock(mutex);
            ends.wait_for(lock, stop, pause, [] { return false; });
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
