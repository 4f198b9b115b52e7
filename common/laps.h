// Measures how long each of several stages takes that follow one another.
#pragma once

#include <chrono>
#include <utility>

namespace framelet {

/// Measures seconds from lap to lap, the first since it was made.
class Laps {
public:
    double lap() {
        auto const now = std::chrono::steady_clock::now();
        return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
    }

private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

} // namespace framelet
