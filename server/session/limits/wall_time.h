// The clock that sessions live by, which nobody sets.
#pragma once

#include <chrono>

namespace framelet {

using WallTime = std::chrono::steady_clock::time_point;

} // namespace framelet
