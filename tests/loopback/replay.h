// Replays a recorded session: gives the same events and turns to the same pipeline. In: a recording, its scene. Out:
// whether the same bytes come out, batch by batch.
#pragma once

#include "server/stream/event_log.h"
#include "server/stream/framelet_stream.h"

namespace framelet {

struct ReplayFigures {
    std::uint64_t turns = 0, batches = 0, bytes = 0;
    double seconds = 0; ///< length of the recording
    std::uint64_t other_steps = 0; ///< turns that were answered otherwise than in the recording
    std::uint64_t other_batches = 0; ///< batches whose bytes are not those of the recording
    std::uint64_t first_other = 0; ///< the first of these, counted from 1; 0: none

    bool is_identical() const { return other_steps == 0 && other_batches == 0; }
};

/// Replays the recording with the scene that it names. Stops at the first turn that is answered otherwise: what follows
/// means nothing then.
ReplayFigures replay(EventLogReader& log, PosedScene& scene);

} // namespace framelet
