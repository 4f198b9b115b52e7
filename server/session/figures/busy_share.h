// Measures how busy the server is. In: the seconds that it has had something to do, and the time, whenever one asks.
// Out: their share of the last second.
#pragma once

#include <algorithm>
#include <chrono>

namespace framelet {

class BusyShare {
public:
    /// `busy_seconds`: since the start. Returns [0, 1], a new figure once half a second has passed since the one
    /// before: over less time it would be of single turns.
    float update(double busy_seconds, std::chrono::steady_clock::time_point now) {
        constexpr double least_seconds = 0.5;
        double const elapsed = std::chrono::duration<double>(now - since_).count();
        if (elapsed >= least_seconds) {
            share_ = static_cast<float>(std::clamp((busy_seconds - busy_before_) / elapsed, 0.0, 1.0));
            since_ = now;
            busy_before_ = busy_seconds;
        }
        return share_;
    }

private:
    std::chrono::steady_clock::time_point since_ = std::chrono::steady_clock::now();
    double busy_before_ = 0;
    float share_ = 0;
};

} // namespace framelet
