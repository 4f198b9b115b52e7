// Scales the changes of combined density that elements ask for so that they add up to nothing, or to no more than has
// been saved ([Stephens 2011] section 6.3). In: changes and their limits. Out: changes of the same signs within the
// limits.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace framelet {

/// Way in which A and B are made equal, A being the sum of the positive changes and B that of the negative ones, both
/// as magnitudes.
enum class Transport {
    shrink_larger, ///< one weight below 1 for the greater of A and B: point b of [Stephens 2011] section 6.3.2.3
    grow_smaller, ///< one weight for A, one for B, as large as the tightest limit of an element allows: points e and f
    fill_smaller, ///< the lesser of A and B grows, every element up to its own limit; then the greater one shrinks
};

/// Account of the running surplus C of combined density (eq. 6.26 to 6.28; 6.27 has the sign the wrong way round: what
/// is given away leaves the account). With `most` = 0 nothing is saved and every transport adds up to 0.
struct Surplus {
    double saved = 0; ///< in [0, most]
    double most = 0;
};

/// Memory reused from call to call, so that nothing is allocated.
struct TransportScratch {
    std::vector<std::uint32_t> order;
    std::vector<double> free; ///< sums of the changes that are not cut
};

/// Scales `changes` in place; `limits[i]` has the sign of `changes[i]` and at least its magnitude. Afterwards
/// sum(changes) <= surplus.saved as it was, and that sum has been taken from the account. Exact but for rounding, in
/// O(n), `fill_smaller` in O(n log n).
void transport(std::span<double> changes, std::span<double const> limits, Transport strategy, Surplus& surplus,
               TransportScratch& scratch);

} // namespace framelet
