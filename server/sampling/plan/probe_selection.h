// Selects the regions that are probed: those that seem to stand, and of which nothing has been seen for long. In: the
// field, the choices, the time. Out: regions, the most suspect first.
#pragma once

#include <vector>

#include "server/sampling/field/price.h"

namespace framelet {

struct ProbeScratch {
    std::vector<std::uint8_t> active; ///< by region: whether it moves
    std::vector<double> suspicions; ///< by region: seconds unseen, 8 times as many beside what moves
};

/// Replaces `probed` by at most `most` regions, the neighbours of what moves first.
void select_probed(RegionField const& field, Choices const& choices, double now, std::size_t most,
                   ProbeScratch& scratch, std::vector<std::uint32_t>& probed);

} // namespace framelet
