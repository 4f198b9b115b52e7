// How long the next picture will take, from how long those before it took: so that it can be made of the moment at which
// it will be seen. In: seconds of each picture. Out: seconds that most of them do not exceed.
#pragma once

#include <algorithm>
#include <cmath>

namespace framelet {

class MakingTime {
public:
    /// In [0, most]. A picture that is ready earlier is shown when this is over, so that motion stays even.
    double expected() const { return std::min(mean_ + deviations * deviation_, most); }

    void note(double seconds) {
        double const taken = std::clamp(seconds, 0.0, most);
        deviation_ += weight * (std::abs(taken - mean_) - deviation_);
        mean_ += weight * (taken - mean_);
    }

private:
    static constexpr double weight = 0.2;
    static constexpr double most = 0.1; ///< what takes longer is late anyway
    /// Mean absolute ones: some nine in ten pictures are ready in time (of normally distributed ones).
    static constexpr double deviations = 1.5;

    double mean_ = 0;
    double deviation_ = 0;
};

} // namespace framelet
