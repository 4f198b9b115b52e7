// Measures the picture once everything stands still: how near to the reference it comes, how soon, whether it stays
// there, and what is still sent. In: scene, machine, link. Out: figures of `framelet` on the virtual clock.
#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/study.h"

namespace framelet::bench {

/// PSNR over the time since the stop. Both lists have the same length, at least one; seconds ascend.
struct PsnrOverTime {
    std::vector<double> seconds;
    std::vector<double> psnr; ///< dB

    /// PSNR, dB, at the last measurement not after `after` seconds, or at the first one.
    double at(double after) const;
    /// Greatest fall below an earlier value, dB.
    double most_fall() const;
};

/// Returns one row a scene: PSNR [dB] at times after the stop, the most by which it ever falls again, when the last
/// message leaves and how much has been sent by then since the stop, and the bytes that are sent in the last second of
/// the run. `options.run.seconds` is the time watched after the stop, at least one second.
nlohmann::json measure_stillness(StudyOptions const& options);

} // namespace framelet::bench
