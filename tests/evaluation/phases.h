// The phases at which a run is made several times. Moments change at multiples of their length of the server's clock,
// and what is rendered when depends on the phase of these, so that one run alone scatters.
#pragma once

#include <cstddef>

#include "server/stream/moment_choice.h"

namespace framelet::bench {

inline constexpr std::size_t phases = 4;
/// Seconds from phase to phase: an eighth of a second spreads them evenly within moments of 0.1, 0.2 and 0.4 s alike.
inline constexpr double phase_step = (least_moment_seconds + most_moment_seconds) / phases;

} // namespace framelet::bench
