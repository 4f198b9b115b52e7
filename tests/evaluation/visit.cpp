#include "tests/evaluation/visit.h"

#include <string>

#include <boost/asio/ip/tcp.hpp>

#include "common/error.h"
#include "protocol/stream_opening.h"

namespace framelet::bench {

namespace asio = boost::asio;

void visit(std::uint16_t port, std::uint32_t codings,
           std::function<bool(FramedStream& stream, Message const& message)> const& receive) {
    asio::io_context io{1};
    asio::ip::tcp::socket socket(io);
    socket.connect({asio::ip::address_v4::loopback(), port});
    auto const stream = plain_stream(std::move(socket));
    bool done = false;
    std::string lost;
    stream->start({[&](Message const& message) {
                       if (auto const* const failure = std::get_if<Failure>(&message)) {
                           lost = failure->text;
                       } else if (!done && receive(*stream, message)) {
                           done = true;
                           stream->close();
                           io.stop();
                       }
                   },
                   [&](std::string reason) {
                       lost = lost.empty() ? std::move(reason) : lost;
                       io.stop();
                   },
                   {}},
                  max_message_bytes);
    stream->send(Hello{protocol_version, {}, codings});
    io.run();
    if (!done) {
        throw ConnectionError("the measured server ended the connection: " + lost);
    }
}

} // namespace framelet::bench
