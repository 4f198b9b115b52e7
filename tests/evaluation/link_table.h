// The project's method beside coded whole frames on the same link and the same server, scene by scene. In: scenes,
// links. Out: the median of the ratio of their errors for each; where that is not as small as it should be, what it
// would be on an unlimited link and on a faster server; as JSON and as charts.
#pragma once

#include <filesystem>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/study.h"

namespace framelet::bench {

struct LinkTableOptions {
    std::vector<std::filesystem::path> scenes;
    std::vector<double> megabits{5, 20, 100}; ///< Mbit/s
    std::vector<double> round_trips_ms{0, 30, 100};
    double goal = 0.5; ///< ratio of the median
};

/// Prints a row for each scene and link. The link of the options' run is not looked at, nor are its methods.
nlohmann::json link_table(LinkTableOptions const& table, StudyOptions const& options);

} // namespace framelet::bench
