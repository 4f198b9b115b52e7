// The clock that sessions live by, which nobody sets.
#pragma once

#include <chrono>

namespace framelet {

using WallTime = std::chrono::steady_clock::time_point;

/// The time as a stream is told it: seconds of this clock.
inline double seconds_of(WallTime time) {
    return std::chrono::duration<double>(time.time_since_epoch()).count();
}

} // namespace framelet
