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

/// A straight line through points, by least squares.
struct Trend {
    double slope = 0;
    double slope_error = 0; ///< its standard error, from how far the points are off the line
    double mean = 0;
    std::size_t points = 0;
};

/// At least three points, not all at one time.
Trend trend_of(std::span<double const> times, std::span<double const> values);

/// It rises as points about a level line do by chance in one of a thousand cases (Student's t, one side), and over
/// `span` by more than `share` of the mean: what an allocator keeps goes up and down by some of that for reasons of its
/// own.
bool grows(Trend const& trend, double span, double share);

} // namespace framelet::bench
