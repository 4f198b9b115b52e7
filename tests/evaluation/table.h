// The 16 runs and five scenes of Table 7.2 of the dissertation ([Stephens 2011]), ours beside the published. In: which
// runs and scenes. Out: suitable percentile, median ratio and cost of every method in every run.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/study.h"

namespace framelet::bench {

struct PublishedRun {
    int number = 0;
    int batch = 0; ///< framelets
    int side = 0; ///< side of the square picture, pixels
    std::vector<double> suitable; ///< suitable percentile, per cent, one a scene
};

struct PublishedTable {
    std::vector<std::string> scenes; ///< stems of the project's scene files
    std::vector<PublishedRun> runs;
};

/// Table 7.2 of A. J. Stephens, "Control of Spatial and Temporal Fidelity with Adaptive Sampling" (dissertation,
/// University of Utah, 2011): for each run the greatest percentile at which the error ratio MSE(adaptive) / MSE(framed
/// at equal total cost) is not above 1; 100: better at all times. Scenes are this project's remakes of its five inputs.
PublishedTable const& published_table();

/// Every run of the table on the study's scenes, cost counted in total as its source did. The table replaces viewport,
/// batch and counting of `study`. Throws InputError for a scene that the table does not have.
nlohmann::json run_table(PublishedTable const& table, StudyOptions const& study);

} // namespace framelet::bench
