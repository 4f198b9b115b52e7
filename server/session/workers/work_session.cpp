#include "server/session/workers/work_session.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "server/render/prepared/prepared_scene.h"
#include "server/workers/order_tracing.h"

namespace framelet {

WorkSession::WorkSession(LoadedScene& scene, std::size_t threads, Events events)
    : scene_(scene), events_(std::move(events)) {
    for (std::size_t i = 0; i < threads; ++i) {
        threads_.emplace_back([this](std::stop_token const& stop) { run(stop); });
    }
}

WorkSession::~WorkSession() {
    for (std::jthread& thread : threads_) {
        thread.request_stop();
    }
    threads_.clear();
}

void WorkSession::take(PathOrder order) {
    {
        std::scoped_lock const lock(mutex_);
        newest_round_ = std::max(newest_round_, order.round);
        waiting_.push_back(std::move(order));
    }
    news_.notify_one();
}

std::optional<PathOrder> WorkSession::next(std::stop_token const& stop) {
    std::unique_lock lock(mutex_);
    if (!news_.wait(lock, stop, [this] { return !waiting_.empty(); }) || stop.stop_requested()) {
        return std::nullopt;
    }
    PathOrder order = std::move(waiting_.front());
    waiting_.pop_front();
    return order;
}

/// True where the server has gone on without it.
bool WorkSession::is_old(PathOrder const& order) {
    std::scoped_lock const lock(mutex_);
    return order.round < newest_round_;
}

bool WorkSession::is_posed_for(PathOrder const& order) const {
    return posed_ == order.scene_time && scene_.render_scene.prepared().display == order.display;
}

PathAnswer WorkSession::trace(PathOrder const& order) {
    while (!is_old(order)) {
        {
            std::shared_lock const tracing(pose_);
            if (is_posed_for(order)) {
                return trace_order(*scene_.posed.path_light(), order);
            }
        }
        std::unique_lock const posing(pose_);
        if (!is_posed_for(order)) {
            posed_.reset();
            scene_.posed.pose(order.scene_time);
            scene_.render_scene.set_display(order.display);
            posed_ = order.scene_time;
        }
    }
    return {order.number, 0, {}};
}

void WorkSession::run(std::stop_token const& stop) {
    try {
        while (auto const order = next(stop)) {
            events_.answer(trace(*order));
        }
    } catch (std::exception const& error) {
        events_.failed(error.what());
    }
}

} // namespace framelet
