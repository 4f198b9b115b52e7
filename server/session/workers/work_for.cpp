#include "server/session/workers/work_for.h"

#include <chrono>
#include <condition_variable>
#include <csignal>
#include <exception>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <spdlog/spdlog.h>

#include "common/error.h"
#include "protocol/connection/server_connection.h"
#include "server/session/workers/work_session.h"

namespace framelet {
namespace {

namespace asio = boost::asio;

constexpr std::chrono::seconds pause{1}; ///< until a server that is gone is looked for again

ConnectionOptions as_worker(ConnectionOptions options, LoadedScene const& scene, std::size_t threads) {
    options.work = {scene.welcome.scene_identity, scene.posed.light_identity(), static_cast<std::uint16_t>(threads)};
    return options;
}

/// Looks for the server, and works for it, again and again.
class WorkerLoop {
public:
    WorkerLoop(ConnectionOptions const& server, LoadedScene& scene, std::size_t threads)
        : options_(as_worker(server, scene, threads)), scene_(scene), threads_(threads) {}

    /// Throws as `work_for`.
    void run(std::stop_token const& stop) {
        std::string complaint;
        while (!stop.stop_requested()) {
            try {
                work(stop);
                complaint.clear();
            } catch (ConnectionRefusal const&) {
                throw;
            } catch (ConnectionError const& error) { // it may come yet
                if (std::exchange(complaint, error.what()) != error.what()) {
                    spdlog::warn("{}: it is tried again", error.what());
                }
            }
            std::unique_lock lock(mutex_);
            news_.wait_for(lock, stop, pause, [] { return false; });
        }
    }

private:
    /// Connects, and works until the connection is lost.
    void work(std::stop_token const& stop) {
        std::unique_ptr<WorkSession> session, ended;
        std::string lost;
        auto const end = [&](std::string const& reason) {
            std::scoped_lock const lock(mutex_);
            lost = lost.empty() ? reason : lost;
            news_.notify_all();
        };
        std::unique_ptr<ServerConnection> connection; // the last: its handlers know of all these
        {
            // Handlers wait with the lock for the connection and the session that they are of.
            std::unique_lock lock(mutex_);
            ServerConnection::Handlers handlers;
            handlers.on_message = [&](Message message) {
                std::scoped_lock const ready(mutex_);
                if (auto* const order = std::get_if<PathOrder>(&message)) {
                    if (session) { // else it is ending
                        session->take(std::move(*order));
                    }
                } else if (!std::holds_alternative<Status>(message)) {
                    throw ProtocolError("a worker is sent orders alone");
                }
            };
            handlers.on_lost = end;
            handlers.on_sent = [] {};
            connection = std::make_unique<ServerConnection>(options_, std::move(handlers));
            session = std::make_unique<WorkSession>(
                scene_, threads_,
                WorkSession::Events{[&](PathAnswer const& answer) { connection->send(answer); }, end});
            spdlog::info("working for {}", options_.server.text());
            news_.wait(lock, stop, [&] { return !lost.empty(); });
            ended = std::move(session);
        }
        ended.reset();
        connection.reset();
        if (!lost.empty()) {
            spdlog::warn("{}", lost);
        }
    }

    ConnectionOptions const options_;
    LoadedScene& scene_;
    std::size_t const threads_;
    std::mutex mutex_;
    std::condition_variable_any news_;
};

} // namespace

void work_for(ConnectionOptions const& server, LoadedScene& scene, std::size_t threads) {
    asio::io_context io;
    asio::signal_set signals(io, SIGINT, SIGTERM);
    signals.async_wait([&](boost::system::error_code error, int signal) {
        if (!error) {
            spdlog::info("ending on signal {}", signal);
            io.stop();
        }
    });
    std::exception_ptr failure;
    WorkerLoop loop(server, scene, threads);
    std::jthread working([&](std::stop_token const& stop) {
        try {
            loop.run(stop);
        } catch (...) {
            failure = std::current_exception();
            io.stop();
        }
    });
    io.run();
    working.request_stop();
    working.join();
    if (failure) {
        std::rethrow_exception(failure);
    }
}

} // namespace framelet
