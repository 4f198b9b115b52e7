// The pause before the next attempt to reach a server that is gone. A value.
#pragma once

#include <algorithm>

namespace framelet {

class BackOff {
public:
    static constexpr double first_seconds = 0.25;
    static constexpr double most_seconds = 8;

    /// The next pause, seconds: twice as long each time, up to `most_seconds`. `chance`, [0, 1), spreads it by a
    /// quarter up and down, so that the viewers of a server that comes back do not all come at once.
    double next(double chance) {
        double const seconds = seconds_ * (0.75 + 0.5 * chance);
        seconds_ = std::min(2 * seconds_, most_seconds);
        return seconds;
    }
    void reset() { seconds_ = first_seconds; }

private:
    double seconds_ = first_seconds;
};

} // namespace framelet
