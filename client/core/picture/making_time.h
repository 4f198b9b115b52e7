// Expects how long the next picture will take from how long those before it took, so that it can be made of the moment
// at which it will be seen. In: seconds of each picture. Out: seconds that are expected.
#pragma once

#include <algorithm>
#include <cmath>

namespace framelet {

class MakingTime {
public:
    /// Seconds that are enough for nearly all pictures, as one that is ready early can wait, and one that is late shows
    /// the past; for most of them where more would cost too many pictures. In [0, most].
    double expected() const {
        double const sure = std::min(mean_ + sure_deviations * deviation_, enough);
        return std::min(std::max(mean_ + least_deviations * deviation_, sure), most);
    }

    void note(double seconds) {
        double const beyond = std::clamp(seconds, 0.0, most) - mean_;
        mean_ += weight * beyond;
        deviation_ += weight * (std::abs(beyond) - deviation_);
    }

private:
    static constexpr double weight = 0.2;
    /// Deviations that are added to the mean: before a camera at 20 m/s a picture that is 3 ms late is wrong by pixels.
    static constexpr double sure_deviations = 3, least_deviations = 0.5;
    static constexpr double enough = 1.0 / 36; ///< seconds: 36 pictures a second leave 30 where some take longer
    static constexpr double most = 0.1; ///< seconds; what takes longer is late anyway

    double mean_ = 0;
    double deviation_ = 0; ///< mean distance from the mean, seconds
};

} // namespace framelet
