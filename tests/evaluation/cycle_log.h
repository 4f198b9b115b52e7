// A log of what a scheduler did in each of its cycles, for judging whether it keeps to its budget. In: the scheduler
// after each step. Out: one entry a cycle.
#pragma once

#include <cstdint>
#include <vector>

#include "server/sampling/plan/adaptive_refresh.h"

namespace framelet::bench {

struct CycleEntry {
    double start = 0; ///< seconds by the run's clock
    double rate = 0; ///< samples a second that the renderer was found to make
    double samples = 0; ///< samples rendered, probes included
};

class CycleLog {
public:
    /// Notes a step that began at `start` (seconds) and has rendered so many samples.
    void add(double start, AdaptiveRefresh const& refresh, std::uint64_t samples);

    std::vector<CycleEntry> const& entries() const { return entries_; }

private:
    std::uint64_t cycle_ = 0;
    std::vector<CycleEntry> entries_;
};

/// Samples rendered beside what the renderer can do in the time, over cycles that start in [from, until). Conservation
/// of the density's integral: the ratio is nowhere above 1 but for errors in the estimated rate.
struct Conservation {
    double samples = 0, budget = 0;
    double largest_share = 0; ///< greatest samples / budget of cycles in a row that last `least_window` or longer
};
inline constexpr double least_window = 0.1; ///< seconds
Conservation measure_conservation(std::vector<CycleEntry> const& entries, double from, double until);

} // namespace framelet::bench
