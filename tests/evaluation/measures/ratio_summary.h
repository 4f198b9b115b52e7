// Summarises one method's error over another's at many times in two numbers ([Stephens 2011] eq. 7.2, Table 7.2).
#pragma once

#include <span>

namespace framelet::bench {

struct RatioSummary {
    double median = 0; ///< median ratio, interpolated between the two middle ones
    double suitable = 0; ///< per cent of the times at which the ratio is <= 1
};

/// `ratios`: >= 0; infinite where the other one's error alone is zero. Throws InputError where there is none, or one is
/// negative or not a number.
RatioSummary summarise_ratios(std::span<double const> ratios);

} // namespace framelet::bench
