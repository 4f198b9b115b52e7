// Scales the changes of combined density that elements ask for so that they add up to nothing ([Stephens 2011] section
// 6.3). In: changes. Out: changes of the same signs, none of them larger.
#pragma once

#include <span>

namespace framelet {

/// Scales `changes` in place: one weight below 1 for the greater of the sums of positive and of negative changes, point
/// b of [Stephens 2011] section 6.3.2.3. Afterwards they add up to 0, but for rounding. O(n).
void transport(std::span<double> changes);

} // namespace framelet
