// `stability`: does the loop of error, density and tiling come to rest? Scenes with events (everything stops, a lamp
// switches, the camera cuts), at several batch sizes, on the virtual clock. Out: for every event how soon the error has
// settled, and how steady tiling, price and budget are.
#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/study.h"

namespace framelet::bench {

struct StabilityOptions {
    std::vector<std::size_t> batches{8, 32, 128, 1024}; ///< framelets
    double factor = 2; ///< settled: within so many times the final level
};

/// Whole scenes. Of `study`, methods, start, seconds and batch are not looked at. InputError for a scene that is not
/// the generator's, or in which nothing happens.
nlohmann::json measure_stability(StabilityOptions const& options, StudyOptions const& study);

} // namespace framelet::bench
