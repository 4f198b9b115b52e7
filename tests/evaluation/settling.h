// Measures how an error over time answers to an event. In: a series, from the event to the next one. Out: how soon it
// has settled, and what it did until then.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace framelet::bench {

/// Errors below this (50 dB) are not told apart from none.
inline constexpr double settled_floor = 1e-5;

struct Settling {
    double final_level = 0; ///< median of the last quarter, at least settled_floor
    double peak = 0;
    std::optional<double> first; ///< seconds from the event until the error is first within the factor of final_level
    std::optional<double> settled; ///< seconds until it stays so; nothing where it does not before the last quarter
    double overshoot = 1; ///< greatest error after `first`, as a multiple of final_level; at least 1
};

/// Measures one event. `times` (ascending, the first at the event or after it) and `errors` have the same length, at
/// least four; `event` is on the same clock; `factor` > 1.
Settling measure_settling(std::span<double const> times, std::span<double const> errors, double event, double factor);

} // namespace framelet::bench
