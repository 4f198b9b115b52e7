// What becomes of the picture once everything stands still: how near to the reference it comes, how soon, whether it
// stays there, and what is still sent. In: scene, machine, link. Out: figures of `framelet` on the virtual clock.
#pragma once

#include <filesystem>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/study.h"

namespace framelet::bench {

struct StillnessStudy {
    std::vector<std::filesystem::path> scenes;
    double stops = 0.5; ///< seconds of scene time that everything moves
    int reference_side = 16; ///< samples along a side of the reference's pixel
};

/// One row a scene: PSNR [dB] at times after the stop, by how much it ever falls again, and the bytes that are sent in
/// the last second of the run. `options.run.seconds` is what is watched after the stop, at least a second.
nlohmann::json measure_stillness(StillnessStudy const& study, StudyOptions const& options);

} // namespace framelet::bench
