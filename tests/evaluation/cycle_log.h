// A log of what a scheduler did in each of its cycles, for judging its steadiness. In: the scheduler after each step.
// Out: one entry a cycle.
#pragma once

#include <cstdint>
#include <vector>

#include "server/sampling/plan/adaptive_refresh.h"

namespace framelet::bench {

struct CycleEntry {
    double start = 0; ///< seconds by the run's clock
    double rate = 0; ///< samples a second that the renderer was found to make
    double samples = 0; ///< samples rendered, probes included
    double price = 0;
    std::size_t patches = 0; ///< patches of the tiling
    std::size_t changed_patches = 0; ///< patches that the tiling before did not have
};

class CycleLog {
public:
    /// Notes a step that began at `start` (seconds) and has rendered so many samples.
    void add(double start, AdaptiveRefresh const& refresh, std::uint64_t samples);

    std::vector<CycleEntry> const& entries() const { return entries_; }

private:
    std::uint64_t cycle_ = 0;
    std::vector<Patch> cut_;
    std::vector<CycleEntry> entries_;
};

/// Measure of how much tiling and price still change: means over the cycles that start in [from, until).
struct Hunting {
    std::size_t cycles = 0;
    double changed_share = 0; ///< share of the tiling's patches that a cycle changes
    double price_octaves = 0; ///< |log2| of the price's change from cycle to cycle
};
Hunting measure_hunting(std::vector<CycleEntry> const& entries, double from, double until);

/// Samples rendered beside what the renderer can do in the time, over cycles that start in [from, until). Conservation
/// of the density's integral: the ratio is nowhere above 1 but for errors in the estimated rate.
struct Conservation {
    double samples = 0, budget = 0;
    double largest_share = 0; ///< greatest samples / budget of cycles in a row that last `least_window` or longer
};
inline constexpr double least_window = 0.1; ///< seconds
Conservation measure_conservation(std::vector<CycleEntry> const& entries, double from, double until);

} // namespace framelet::bench
