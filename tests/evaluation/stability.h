// The verb `stability`: does the error come to rest, and is the budget kept? Scenes with events (everything stops,
// a lamp switches, the camera cuts), at several batch sizes, on the virtual clock. Out: for every event how soon the
// error has settled, and the samples rendered beside those that there was time for.
#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/study.h"

namespace framelet::bench {

/// Runs whole scenes, once for each of `batches` (most framelets of a batch). Ignores methods, start, seconds and batch
/// of `study`. Throws InputError for a scene that is not the generator's, or in which nothing happens.
nlohmann::json measure_stability(StudyOptions const& study, std::vector<std::size_t> const& batches);

} // namespace framelet::bench
