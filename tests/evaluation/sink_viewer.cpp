#include "tests/evaluation/sink_viewer.h"

#include <chrono>
#include <set>

#include "tests/evaluation/visit.h"

namespace framelet::bench {

using std::chrono::steady_clock;

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
            record.batches.push_back(batch->tiles);
            record.samples += batch->tiles.size() * framelet_samples;
            record.payload_bytes += batch->payload.size();
            stream.send(Ack{batch->number, 0, 0});
        } else if (auto const* const status = std::get_if<Status>(&message)) {
            // The word that it is complete may overtake the last batch, which is still being encoded.
            return status->converged && status->camera_number == 1 && status->last_batch == newest;
        }
        return false;
    };
    visit(port, coding::all, receive);
    record.seconds = std::chrono::duration<double>(last - start).count();
    return record;
}

} // namespace framelet::bench
