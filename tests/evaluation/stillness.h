// What becomes of the picture once everything stands still: how near to the reference it comes, how soon, whether it
// stays there, and what is still sent. In: scene, machine, link. Out: figures of `framelet` on the virtual clock.
#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/study.h"

namespace framelet::bench {

/// How good the picture was when, since the stop. As many of each, at least one; seconds ascend.
struct PsnrOverTime {
    std::vector<double> seconds;
    std::vector<double> psnr; ///< dB

    /// At the last measurement not after `after` seconds, or the first one.
    double at(double after) const;
    /// The most that it was ever below what it had been, dB.
    double most_fall() const;
};

/// One row a scene: PSNR [dB] at times after the stop, by how much it ever falls again, when the last message leaves
/// and how much has been sent by then since the stop, and the bytes that are sent in the last second of the run.
/// `options.run.seconds` is what is watched after the stop, at least a second.
nlohmann::json measure_stillness(StudyOptions const& options);

} // namespace framelet::bench
