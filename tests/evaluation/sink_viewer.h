// A viewer that asks for a picture and looks at nothing: it acknowledges batches without decoding them, so that what is
// measured is the server. It leaves when the first tile comes once more: from then on samples take four rays.
#pragma once

#include <cstdint>
#include <vector>

#include "common/camera.h"
#include "common/tile.h"

namespace framelet::bench {

/// What the server sent for one still view, from the first camera until it has every tile with one ray a sample.
struct SinkRecord {
    std::vector<std::vector<Tile>> batches;
    double seconds = 0; ///< from the camera's departure to the arrival of the last batch
    std::size_t samples = 0;
    std::size_t payload_bytes = 0;
};

/// Connects to 127.0.0.1:port and stays until the picture has converged or a tile comes that it had. Throws
/// ConnectionError.
SinkRecord watch_until_repeated(std::uint16_t port, Camera const& camera, Viewport viewport);

} // namespace framelet::bench
