// The handlers whom a connection tells what comes, until it tells nobody any more. All members may be called from any
// thread.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <utility>

#include "protocol/stream/framed_stream.h"

namespace framelet {

class HandlerSlot {
public:
    using Handlers = FramedStream::Handlers;

    /// Sets the handlers; false where nobody is to be told any more.
    bool set(Handlers handlers) {
        std::scoped_lock const lock(mutex_);
        if (is_closed_) {
            return false;
        }
        handlers_ = std::make_shared<Handlers>(std::move(handlers));
        return true;
    }
    /// The handlers; null: nobody is to be told. They are kept alive while they run, whatever they close.
    std::shared_ptr<Handlers> get() {
        std::scoped_lock const lock(mutex_);
        return handlers_;
    }
    /// Takes the handlers out: from here on no callback begins.
    std::shared_ptr<Handlers> take() {
        std::scoped_lock const lock(mutex_);
        is_closed_ = true;
        return std::exchange(handlers_, nullptr);
    }
    bool is_closed() const { return is_closed_; }

private:
    std::mutex mutex_;
    std::shared_ptr<Handlers> handlers_;
    std::atomic<bool> is_closed_ = false;
};

} // namespace framelet
