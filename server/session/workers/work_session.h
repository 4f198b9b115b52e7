// Traces paths of light for another server, which shows them to viewers: the worker's side of one connection. In: a
// scene of its own, orders. Out: answers. A resource; owns threads.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "protocol/messages/message.h"
#include "server/session/loaded_scene.h"

namespace framelet {

class WorkSession {
public:
    struct Events {
        std::function<void(PathAnswer const&)> answer; ///< called on any thread
        std::function<void(std::string const& reason)> failed; ///< likewise: it cannot go on, one line
    };

    /// The scene's light has to be by paths; nobody else poses it meanwhile.
    WorkSession(LoadedScene& scene, std::size_t threads, Events events);
    ~WorkSession();
    WorkSession(WorkSession const&) = delete;
    WorkSession& operator=(WorkSession const&) = delete;

    /// Takes an order, to be answered sometime; one of an older round than the newest is answered with nothing.
    void take(PathOrder order);

private:
    std::optional<PathOrder> next(std::stop_token const& stop);
    bool is_old(PathOrder const& order);
    bool is_posed_for(PathOrder const& order) const;
    PathAnswer trace(PathOrder const& order);
    void run(std::stop_token const& stop);

    LoadedScene& scene_;
    Events const events_;
    std::mutex mutex_;
    std::condition_variable_any news_;
    std::deque<PathOrder> waiting_;
    std::uint64_t newest_round_ = 0;
    std::shared_mutex pose_; ///< held by who traces, and by the one that poses alone
    std::optional<SceneTime> posed_; ///< nothing: posing it has failed, or it was not posed yet
    std::vector<std::jthread> threads_;
};

} // namespace framelet
