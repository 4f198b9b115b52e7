// Sets a running server's scene clock to 0 and lets it play, as a viewer that asks for no picture.
#pragma once

#include <cstdint>

namespace framelet::bench {

/// Connects to 127.0.0.1:port. Returns the moment at which the scene's time was 0, Unix seconds; it is late by what the
/// server's word takes over loopback. Throws ConnectionError.
double start_scene_clock(std::uint16_t port);

} // namespace framelet::bench
