// The real server and the real client as processes, through a link emulator, on the wall clock: what the client showed
// against the reference, and what the virtual clock predicts for the same machine. In: scene, link, threads. Out:
// figures of both.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/study.h"

namespace framelet::bench {

struct WallOptions {
    int server_threads = 1;
    double display_rate = 60; ///< frames a second that the client shows
    double most_lead_seconds = 30; ///< how long the still picture at time 0 may take to be complete
};

/// Prints and returns the figures, draws the error over time where `study.charts` says so. Of `study`, methods,
/// counting and frames a second do not matter. Throws InputError or ConnectionError where a program fails; what they
/// leave behind is removed.
nlohmann::json measure_wall(BenchScene& scene, StudyOptions const& study, WallOptions const& options);

} // namespace framelet::bench
