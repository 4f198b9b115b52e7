// Samples of framelets without loss: planes of differences. In: framelets. Out: bytes, and back.
#pragma once

#include <cstddef>
#include <cstdint>

#include "common/framelet/framelet.h"

namespace framelet {

inline constexpr std::size_t exact_framelet_bytes = std::size_t{3} * framelet_samples;

/// Turns 256 samples in Morton order into 256 differences in raster order, modulo 256: from the left neighbour, in the
/// first column from the upper one.
void difference(std::array<std::uint8_t, framelet_samples> const& samples, std::uint8_t* out);
void undo_difference(std::uint8_t const* in, std::array<std::uint8_t, framelet_samples>& samples);

/// Calls `body(plane)` with the member that is red, green and blue, in turn.
template <typename Body>
void for_each_plane(Body const& body) {
    body(&DisplayFramelet::red);
    body(&DisplayFramelet::green);
    body(&DisplayFramelet::blue);
}

} // namespace framelet
