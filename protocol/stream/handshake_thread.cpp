#include "protocol/stream/handshake_thread.h"

#include <chrono>
#include <exception>

namespace framelet {

HandshakeThread::HandshakeThread() : thread_([this] { run(); }) {}

HandshakeThread::~HandshakeThread() {
    stop();
}

void HandshakeThread::stop() {
    if (!thread_.joinable()) {
        return;
    }
    io_.stop();
    thread_.join();
    io_.restart();
    stays_.reset();
    run();
}

void HandshakeThread::run() {
    for (;;) {
        try {
            io_.run();
            return;
        } catch (std::exception const&) { // for want of memory: that handshake is stuck, and its connection ends for it
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
    }
}

} // namespace framelet
