#include "tests/evaluation/start_clock.h"

#include <chrono>
#include <optional>
#include <string>

#include <boost/asio/ip/tcp.hpp>

#include "common/error.h"
#include "protocol/framed_stream.h"

namespace framelet::bench {

namespace asio = boost::asio;

double start_scene_clock(std::uint16_t port) {
    asio::io_context io{1};
    asio::ip::tcp::socket socket(io);
    socket.connect({asio::ip::address_v4::loopback(), port});
    auto const stream = FramedStream::plain(std::move(socket));
    std::optional<double> start;
    std::string lost;
    auto const receive = [&](Message const& message) {
        if (std::holds_alternative<Welcome>(message)) {
            stream->send(ClockRequest{ClockRequest::time | ClockRequest::playing, {0, true, 1}});
        } else if (auto const* const status = std::get_if<Status>(&message); status && status->clock.playing) {
            std::chrono::duration<double> const now = std::chrono::system_clock::now().time_since_epoch();
            start = now.count() - status->clock.time;
            stream->close();
            io.stop();
        } else if (auto const* const failure = std::get_if<Failure>(&message)) {
            lost = failure->text;
        }
    };
    stream->start({receive,
                   [&](std::string reason) {
                       lost = lost.empty() ? std::move(reason) : lost;
                       io.stop();
                   },
                   {}},
                  max_message_bytes);
    stream->send(Hello{protocol_version, {}});
    io.run();
    if (!start) {
        throw ConnectionError("the measured server ended the connection: " + lost);
    }
    return *start;
}

} // namespace framelet::bench
