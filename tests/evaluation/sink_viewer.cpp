#include "tests/evaluation/sink_viewer.h"

#include <chrono>
#include <string>

#include <boost/asio/ip/tcp.hpp>

#include "common/error.h"
#include "protocol/framed_stream.h"

namespace framelet::bench {

namespace asio = boost::asio;
using std::chrono::steady_clock;

SinkRecord watch_until_converged(std::uint16_t port, Camera const& camera, Viewport viewport) {
    asio::io_context io{1};
    asio::ip::tcp::socket socket(io);
    socket.connect({asio::ip::make_address("127.0.0.1"), port});
    auto const stream = FramedStream::plain(std::move(socket));

    SinkRecord record;
    steady_clock::time_point start, last;
    std::uint64_t newest = 0;
    std::string lost;
    auto const receive = [&](Message const& message) {
        if (std::holds_alternative<Welcome>(message)) {
            start = steady_clock::now();
            stream->send(CameraUpdate{{1, camera, viewport}, -1});
        } else if (auto const* const batch = std::get_if<EncodedBatch>(&message)) {
            last = steady_clock::now();
            newest = batch->number;
            record.batches.push_back(batch->tiles);
            record.samples += batch->tiles.size() * framelet_samples;
            record.payload_bytes += batch->payload.size();
            stream->send(Ack{batch->number, 0, 0});
        } else if (auto const* const failure = std::get_if<Failure>(&message)) {
            lost = failure->text;
        } else if (auto const* const status = std::get_if<Status>(&message)) {
            // The word that it is complete may overtake the last batch, which is still being encoded.
            if (status->converged && status->camera_number == 1 && status->last_batch == newest) {
                stream->close();
                io.stop();
            }
        }
    };
    stream->start({receive,
                   [&](std::string reason) {
                       lost = lost.empty() ? std::move(reason) : lost;
                       io.stop();
                   },
                   {}},
                  max_message_bytes);
    stream->send(Hello{protocol_version, {}, coding::all});
    io.run();
    if (!lost.empty()) {
        throw ConnectionError("the measured server ended the connection: " + lost);
    }
    record.seconds = std::chrono::duration<double>(last - start).count();
    return record;
}

} // namespace framelet::bench
