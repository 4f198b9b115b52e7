// Shows what framelet-client shows in a running tev as well, from a thread of its own: nobody waits for tev.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>

#include "client/frames/frame_sink.h"
#include "common/camera.h"
#include "protocol/connection/server_address.h"

namespace framelet {

inline constexpr std::uint16_t default_tev_port = 14158;

class TevSender : public FrameSink {
public:
    /// Connects (blocks) and creates the image. Throws ConnectionError where no tev is there.
    TevSender(ServerAddress const& tev, std::string const& image_name, Viewport size);
    ~TevSender() override;

    /// Sends the picture where it has changed; of those that come while one is on its way, only the newest.
    void show(ShownFrame const& frame) override;
    /// Waits until the last picture is sent.
    void finish() override;
    std::string end_reason() const override;
    double cpu_seconds() const override { return cpu_seconds_; }

private:
    void run();
    void stop();

    ServerAddress const tev_;
    std::string const name_;
    boost::asio::io_context io_;
    boost::asio::ip::tcp::socket socket_{io_};
    std::atomic<double> cpu_seconds_ = 0;

    mutable std::mutex mutex_; // guards what follows
    std::condition_variable changed_;
    std::optional<Picture> waiting_;
    bool stopping_ = false;
    std::string end_reason_;

    std::thread thread_;
};

} // namespace framelet
