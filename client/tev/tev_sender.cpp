#include "client/tev/tev_sender.h"

#include <utility>

#include <boost/asio/connect.hpp>
#include <boost/asio/write.hpp>
#include <sys/socket.h>

#include "client/tev/tev_packets.h"
#include "common/cpu_clock.h"
#include "common/error.h"

namespace framelet {

namespace asio = boost::asio;

TevSender::TevSender(ServerAddress const& tev, std::string const& image_name, Viewport size)
    : tev_(tev), name_(image_name) {
    try {
        asio::connect(socket_, asio::ip::tcp::resolver(io_).resolve(tev.host, std::to_string(tev.port)));
        asio::write(socket_, asio::buffer(tev_create_image(name_, size)));
    } catch (boost::system::system_error const& error) {
        throw ConnectionError("cannot reach tev at " + tev.text() + " (" + error.code().message() +
                              "): start it first, or say with --tev where it listens");
    }
    thread_ = std::thread([this] { run(); });
}

TevSender::~TevSender() {
    if (thread_.joinable()) {
        ::shutdown(socket_.native_handle(), SHUT_RDWR); // a tev that takes nothing would be waited for
        stop();
    }
}

void TevSender::show(ShownFrame const& frame) {
    if (!frame.changed) {
        return;
    }
    {
        std::lock_guard const lock(mutex_);
        waiting_ = frame.picture;
    }
    changed_.notify_all();
}

void TevSender::stop() {
    {
        std::lock_guard const lock(mutex_);
        stopping_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void TevSender::finish() {
    stop();
}

std::string TevSender::end_reason() const {
    std::lock_guard const lock(mutex_);
    return end_reason_;
}

void TevSender::run() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [this] { return stopping_ || waiting_; });
        if (!waiting_) {
            return;
        }
        Picture const picture = std::move(*std::exchange(waiting_, std::nullopt));
        lock.unlock();
        boost::system::error_code error;
        asio::write(socket_, asio::buffer(tev_update_image(name_, picture)), error);
        cpu_seconds_ = cpu_seconds_of(CLOCK_THREAD_CPUTIME_ID);
        lock.lock();
        if (error) {
            end_reason_ = "tev at " + tev_.text() + " has gone (" + error.message() + ")";
            return;
        }
    }
}

} // namespace framelet
