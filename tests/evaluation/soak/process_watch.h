// Tells how much memory and how many descriptors a process holds, as the system counts them, and whether that grows.
#pragma once

#include <cstddef>
#include <span>

#include <sys/types.h>

namespace framelet::bench {

struct ProcessHoldings {
    double resident_bytes = 0;
    std::size_t descriptors = 0; ///< number of open descriptors
};

/// Holdings of a process; zeros where there is no such process.
ProcessHoldings holdings_of(pid_t pid);

/// Growth of values from a first time to a second, pair by pair.
struct Growth {
    double mean = 0;
    double error = 0; ///< standard error of the mean, from how much the pairs differ
    double before = 0; ///< mean of the values of the first time
    std::size_t pairs = 0;
};

/// Growth from `before` to `after`, which must have the same length, at least two.
Growth growth_of(std::span<double const> before, std::span<double const> after);

/// True if the growth is more than comes by chance in one of a thousand cases (Student's t, one side), and more than
/// `share` of the values before: the memory that an allocator keeps goes up and down by some of that for other reasons.
bool grows(Growth const& growth, double share);

} // namespace framelet::bench
