// What a process holds, as the system counts it, and whether that grows.
#pragma once

#include <cstddef>
#include <span>

#include <sys/types.h>

namespace framelet::bench {

struct ProcessHoldings {
    double resident_bytes = 0;
    std::size_t descriptors = 0; ///< that are open
};

/// Zeros where there is no such process.
ProcessHoldings holdings_of(pid_t pid);

/// How much more values are the second time than the first, pair by pair.
struct Growth {
    double mean = 0;
    double error = 0; ///< its standard error, from how much the pairs differ
    double before = 0; ///< mean the first time
    std::size_t pairs = 0;
};

/// At least two pairs, and as many values each time.
Growth growth_of(std::span<double const> before, std::span<double const> after);

/// It is more than what comes by chance in one of a thousand cases (Student's t, one side), and more than `share` of
/// what there was: what an allocator keeps goes up and down by some of that for reasons of its own.
bool grows(Growth const& growth, double share);

} // namespace framelet::bench
