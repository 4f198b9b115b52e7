// What a scheduler did in each of its cycles, for judging its steadiness. In: the scheduler after each step. Out: one
// entry a cycle.
#pragma once

#include <cstdint>
#include <vector>

#include "server/sampling/plan/adaptive_refresh.h"

namespace framelet::bench {

struct CycleEntry {
    double start = 0; ///< seconds
    double rate = 0; ///< samples a second that the renderer was found to make
    double samples = 0; ///< rendered, probes included
    double price = 0;
    std::size_t patches = 0; ///< of the tiling
    std::size_t changed_patches = 0; ///< of these, not in the tiling before
};

class CycleLog {
public:
    /// A step that began at `start` has rendered so many samples.
    void add(double start, AdaptiveRefresh const& refresh, std::uint64_t samples);

    std::vector<CycleEntry> const& entries() const { return entries_; }

private:
    std::uint64_t cycle_ = 0;
    std::vector<Patch> cut_;
    std::vector<CycleEntry> entries_;
};

/// Means over cycles that start in [from, until).
struct Hunting {
    std::size_t cycles = 0;
    double changed_share = 0; ///< of the tiling's patches, a cycle
    double price_octaves = 0; ///< |log2| of the price's change, a cycle
};
Hunting measure_hunting(std::vector<CycleEntry> const& entries, double from, double until);

/// Samples against what the renderer can do in the time, over cycles that start in [from, until). Conservation of the
/// density's integral: nowhere above 1 but for what a rate is misjudged.
struct Conservation {
    double samples = 0, budget = 0;
    double largest_share = 0; ///< most samples / budget of cycles in a row that last for `least_window` or longer
};
inline constexpr double least_window = 0.1; ///< seconds
Conservation measure_conservation(std::vector<CycleEntry> const& entries, double from, double until);

} // namespace framelet::bench
