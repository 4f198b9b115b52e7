#include "tests/evaluation/limits.h"

#include <chrono>
#include <cstdio>
#include <functional>
#include <set>
#include <string>
#include <thread>

#include <boost/asio/ip/tcp.hpp>
#include <nlohmann/json.hpp>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include "common/error.h"
#include "protocol/stream/framed_stream.h"
#include "protocol/stream/stream_opening.h"
#include "server/session/server.h"
#include "tests/evaluation/stopwatch.h"

namespace framelet::bench {
namespace {

namespace asio = boost::asio;
using std::chrono::steady_clock;

/// Record of what the server sent for one still view, from the first camera until it has sent every tile with one ray a
/// sample.
struct SinkRecord {
    std::vector<Tile> tiles;
    double seconds = 0; ///< time from the camera's departure to the arrival of the last batch
    std::size_t payload_bytes = 0;
};

/// Connects to 127.0.0.1:port, says hello and hands over each message, the Welcome first, until `receive` returns true,
/// which says that it has what it wanted. Throws ConnectionError where the server ends the connection before.
void visit(std::uint16_t port, std::function<bool(FramedStream& stream, Message const& message)> const& receive) {
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
    stream->send(Hello{protocol_version, {}, coding::all});
    io.run();
    if (!done) {
        throw ConnectionError("the measured server ended the connection: " + lost);
    }
}

/// Plays a viewer that looks at nothing: it acknowledges batches without decoding them, so that what is measured is the
/// server. It stays until the picture has converged or a tile comes once more, which takes four rays a sample.
SinkRecord watch_until_repeated(std::uint16_t port, Camera const& camera, Viewport viewport) {
    SinkRecord record;
    steady_clock::time_point start, last;
    std::uint64_t newest = 0;
    std::set<Tile> seen;
    auto const receive = [&](FramedStream& stream, Message const& message) {
        if (std::holds_alternative<Welcome>(message)) {
            start = steady_clock::now();
            stream.send(CameraUpdate{{1, camera, viewport}, -1});
        } else if (auto const* const batch = std::get_if<EncodedBatch>(&message)) {
            for (Tile const tile : batch->tiles) {
                if (!seen.insert(tile).second) {
                    return true;
                }
            }
            last = steady_clock::now();
            newest = batch->number;
            record.tiles.insert(record.tiles.end(), batch->tiles.begin(), batch->tiles.end());
            record.payload_bytes += batch->payload.size();
            stream.send(Ack{batch->number, 0, 0});
        } else if (auto const* const status = std::get_if<Status>(&message)) {
            // The status that says that the view is complete may overtake the last batch, which is still being encoded.
            return status->converged && status->camera_number == 1 && status->last_batch == newest;
        }
        return false;
    };
    visit(port, receive);
    record.seconds = std::chrono::duration<double>(last - start).count();
    return record;
}

/// Seconds for rendering the same tiles as the server's batches, in one parallel loop over all of them.
double bare_loop_seconds(BenchScene& scene, Viewport viewport, std::vector<Tile> const& tiles) {
    ImagePlane const plane(viewport);
    ViewRays const rays = make_view_rays(scene.camera, viewport);
    return seconds_of([&] {
        tbb::parallel_for(std::size_t(0), tiles.size(), [&](std::size_t i) {
            thread_local Framelet framelet;
            render_framelet(*scene.render_scene, rays, plane, tiles[i], framelet);
        });
    });
}

} // namespace

nlohmann::json measure_limits(BenchScene& scene, Viewport viewport, int rounds) {
    ServerOptions server_options;
    server_options.port = 0;
    server_options.paused = true;
    server_options.loop.stream.exposure = scene.exposure;
    PosedScene posed(scene.scene, scene.clips, *scene.render_scene);
    Server server(posed, server_options);
    std::jthread const running([&server] { server.run(); });

    std::vector<double> ratios, server_rates, bare_rates;
    SinkRecord record;
    for (int round = 0; round < rounds; ++round) {
        record = watch_until_repeated(server.port(), scene.camera, viewport);
        double const samples = static_cast<double>(record.tiles.size() * framelet_samples);
        server_rates.push_back(samples / record.seconds);
        bare_rates.push_back(samples / bare_loop_seconds(scene, viewport, record.tiles));
        ratios.push_back(server_rates.back() / bare_rates.back());
    }
    server.stop();
    std::size_t const samples = record.tiles.size() * framelet_samples;
    double const bytes_per_sample = static_cast<double>(record.payload_bytes) / static_cast<double>(samples);
    int const threads = tbb::info::default_concurrency();
    std::printf("%s, %dx%d, %d threads, medians of %d rounds\n", scene.name.c_str(), viewport.width, viewport.height,
                threads, rounds);
    std::printf("bare Embree + shading loop  %8.2f Msamples/s\n", median(bare_rates) / 1e6);
    std::printf("whole server                %8.2f Msamples/s, %.3f of the bare loop, %.2f B/sample on the wire\n",
                median(server_rates) / 1e6, median(ratios), bytes_per_sample);
    return {{"scene", scene.name},
            {"viewport", {viewport.width, viewport.height}},
            {"threads", threads},
            {"samples", samples},
            {"bytes_per_sample", bytes_per_sample},
            {"server_samples_per_second", median(server_rates)},
            {"bare_samples_per_second", median(bare_rates)},
            {"ratio", median(ratios)}};
}

} // namespace framelet::bench
