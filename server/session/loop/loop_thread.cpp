#include "server/session/loop/loop_thread.h"

#include <utility>

namespace framelet {

void LoopThread::start() {
    thread_ = std::thread([serving = loop_.get()] { serving->run(); });
}

void LoopThread::stop() {
    if (thread_.joinable()) {
        loop_->stop();
        thread_.join();
    }
}

void LoopThread::replace(std::unique_ptr<SessionLoop> next) {
    std::scoped_lock const lock(mutex_);
    earlier_rays_ += loop_->rays();
    earlier_busy_seconds_ += loop_->busy_seconds();
    std::swap(loop_, next);
}

void LoopThread::add_figures(ServerFigures& figures) const {
    std::scoped_lock const lock(mutex_);
    figures.healthy = figures.healthy && loop_->has_scene();
    figures.rays = earlier_rays_ + loop_->rays();
    figures.busy_seconds = busy_seconds();
    figures.rays_per_second = loop_->samples_per_second();
}

} // namespace framelet
