// How many paths for the light cache take the share of time that is theirs. In: what samples and paths took lately, how
// well the light is known. Out: paths beside so many samples.
#pragma once

#include <algorithm>
#include <cstddef>

namespace framelet {

class LearningShare {
public:
    /// Paths that there is time for beside so many samples: for as much as the light that is shown is off, and for
    /// checks, so that it never lags behind what moves.
    std::size_t paths_beside(std::size_t samples) const {
        constexpr double most = 1.0 / 3, least = 1.0 / 9; // of the time of both
        constexpr double large_error = 0.2;
        double const share = most * std::clamp(error_ / large_error, least / most, 1.0);
        double const paths = static_cast<double>(samples) * sample_seconds_ / path_seconds_ * share / (1 - share);
        return static_cast<std::size_t>(paths);
    }

    /// Paths that take so many processor seconds, about.
    std::size_t paths_in(double seconds) const { return static_cast<std::size_t>(seconds / path_seconds_); }

    /// Takes in the standard error of the light that is shown, relative.
    void note_error(double error) { error_ = error; }

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

    double error_ = 1;
    double sample_seconds_ = 1e-6, path_seconds_ = 6e-6; ///< of one, at first as is usual
};

} // namespace framelet
