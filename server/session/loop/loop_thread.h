// The loop of the scene that is served, on its thread, and the loops of scenes before. A resource; owns the thread.
#pragma once

#include <memory>
#include <mutex>
#include <thread>

#include "server/session/figures/server_figures.h"
#include "server/session/loop/session_loop.h"

namespace framelet {

/// One thread may use it, but for `wake` and `samples_per_second`, which the loop's own may call as well, and for
/// `add_figures`, which any may.
class LoopThread {
public:
    explicit LoopThread(std::unique_ptr<SessionLoop> loop) : loop_(std::move(loop)) {}

    void start();
    /// Stops the loop and waits until it has ended. Does nothing where it has not been started.
    void stop();
    /// Replaces the loop, which has been stopped.
    void replace(std::unique_ptr<SessionLoop> next);

    void wake() { loop_->wake(); }
    double samples_per_second() const { return loop_->samples_per_second(); }
    /// Seconds in which any of the loops had something to do.
    double busy_seconds() const { return earlier_busy_seconds_ + loop_->busy_seconds(); }
    /// Fills in what the loops have done, all together; not healthy where there is no memory for the scene.
    void add_figures(ServerFigures& figures) const;

private:
    mutable std::mutex mutex_; ///< held while the loop is replaced, and by whoever might see that
    std::unique_ptr<SessionLoop> loop_;
    double earlier_rays_ = 0, earlier_busy_seconds_ = 0; ///< of loops before this one
    std::thread thread_;
};

} // namespace framelet
