// How long the next picture will take, from how long those before it took: so that it can be made of the moment at which
// it will be seen. In: seconds of each picture. Out: seconds that are expected.
#pragma once

#include <algorithm>

namespace framelet {

class MakingTime {
public:
    /// In [0, most].
    double expected() const { return mean_; }

    void note(double seconds) { mean_ += weight * (std::clamp(seconds, 0.0, most) - mean_); }

private:
    static constexpr double weight = 0.2;
    static constexpr double most = 0.1; ///< what takes longer is late anyway

    double mean_ = 0;
};

} // namespace framelet
