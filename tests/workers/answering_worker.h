// A worker in this process, with a thread of its own. For tests only.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>

#include "server/workers/worker_pool.h"

namespace framelet {

class AnsweringWorker {
public:
    using Answer = std::function<PathAnswer(PathOrder const&)>;

    /// Joins the pool, which must outlive it.
    AnsweringWorker(WorkerPool& pool, WorkerPool::Id id, Answer answer)
        : pool_(pool), id_(id), answer_(std::move(answer)),
          thread_([this](std::stop_token const& stop) { run(stop); }) {
        pool_.join(id, {1,
                        [inbox = inbox_](PathOrder const& order) {
                            std::scoped_lock const lock(inbox->mutex);
                            inbox->orders.push_back(order);
                            inbox->news.notify_all();
                        },
                        [](std::string const& reason) { ADD_FAILURE() << reason; }});
    }
    ~AnsweringWorker() { pool_.leave(id_); }

    /// Waits until it has done what it was asked.
    void wait_until_done() {
        std::unique_lock lock(inbox_->mutex);
        inbox_->news.wait(lock, [this] { return inbox_->orders.empty(); });
    }

private:
    /// A pool may still be sending while its worker leaves.
    struct Inbox {
        std::mutex mutex;
        std::condition_variable_any news;
        std::deque<PathOrder> orders;
    };

    void run(std::stop_token const& stop) {
        std::unique_lock lock(inbox_->mutex);
        while (inbox_->news.wait(lock, stop, [this] { return !inbox_->orders.empty(); })) {
            PathOrder const order = inbox_->orders.front();
            lock.unlock();
            pool_.answer(id_, answer_(order));
            lock.lock();
            inbox_->orders.pop_front();
            inbox_->news.notify_all();
        }
    }

    WorkerPool& pool_;
    WorkerPool::Id const id_;
    Answer const answer_;
    std::shared_ptr<Inbox> const inbox_ = std::make_shared<Inbox>();
    std::jthread thread_;
};

} // namespace framelet
