// What the verbs that compare methods are told.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/evaluation/cost_table.h"
#include "tests/evaluation/reference.h"
#include "tests/evaluation/run.h"

namespace framelet::bench {

struct StudyOptions {
    std::vector<std::string> methods;
    RunParameters run;
    int samples_per_side = 3; ///< of the reference
    std::filesystem::path reference_cache = default_reference_cache();
    std::filesystem::path charts; ///< folder; empty: none are drawn
    CostTable costs;
};

/// Renders what the cache lacks of the reference for such a run.
inline Reference reference_of(BenchScene& scene, StudyOptions const& options) {
    return {scene,
            {options.run.viewport, options.run.seconds, options.run.reference_rate, options.samples_per_side},
            options.reference_cache};
}

} // namespace framelet::bench
