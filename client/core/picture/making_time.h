// Expects how long the next picture will take from how long those before it took, so that it can be made of the moment
// at which it will be seen. In: seconds of each picture. Out: seconds that are expected.
#pragma once

#include <algorithm>
#include <cmath>

namespace framelet {

class MakingTime {
public:
    /// Seconds that are enough for most pictures, as one that is ready early can wait, and one that is late shows the
    /// past. In [0, most].
    double expected() const { return std::min(mean_ + deviations * deviation_, most); }

    void note(double seconds) {
        double const beyond = std::clamp(seconds, 0.0, most) - mean_;
        mean_ += weight * beyond;
        deviation_ += weight * (std::abs(beyond) - deviation_);
    }

private:
    static constexpr double weight = 0.2;
    /// Deviations that are added to the mean; more costs more pictures than it makes right.
    static constexpr double deviations = 0.5;
    static constexpr double most = 0.1; ///< seconds; what takes longer is late anyway

    double mean_ = 0;
    double deviation_ = 0; ///< mean distance from the mean, seconds
};

} // namespace framelet
