// A viewer that asks for a picture and looks at nothing: it acknowledges batches without decoding them, so that what is
// measured is the server.
#pragma once

#include <cstdint>
#include <vector>

#include "common/camera.h"
#include "common/tile.h"

namespace framelet::bench {

/// What the server sent for one still view, from the first camera to convergence.
struct SinkRecord {
    std::vector<std::vector<Tile>> batches;
    double seconds = 0; ///< from the camera's departure to the arrival of the last batch
    std::size_t samples = 0;
    std::size_t payload_bytes = 0;
};

/// Connects to 127.0.0.1:port and stays until the picture has converged. Throws ConnectionError.
SinkRecord watch_until_converged(std::uint16_t port, Camera const& camera, Viewport viewport);

} // namespace framelet::bench
