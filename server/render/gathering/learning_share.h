// How many paths for the light cache take the share of time that is theirs. In: what samples and paths took lately.
// Out: paths beside so many samples.
#pragma once

#include <algorithm>
#include <cstddef>

namespace framelet {

class LearningShare {
public:
    /// Paths that there is time for beside so many samples.
    std::size_t paths_beside(std::size_t samples) const {
        constexpr double share = 1.0 / 3; // of the time of both
        double const paths = static_cast<double>(samples) * sample_seconds_ / path_seconds_ * share / (1 - share);
        return static_cast<std::size_t>(paths);
    }

    /// Takes in the processor seconds that some samples and some paths have taken, with all their rays.
    void note(std::size_t samples, double samples_took, std::size_t paths, double paths_took) {
        note(sample_seconds_, samples, samples_took);
        note(path_seconds_, paths, paths_took);
    }

private:
    static void note(double& seconds, std::size_t count, double took) {
        constexpr double remembered = 1 << 14; // of either: single ones may be held up by other programs
        double const weight = std::min(static_cast<double>(count) / remembered, 0.5);
        if (count > 0) {
            seconds += weight * (std::max(took / static_cast<double>(count), 1e-9) - seconds);
        }
    }

    double sample_seconds_ = 1e-6, path_seconds_ = 6e-6; ///< of one, at first as is usual
};

} // namespace framelet
