// Which places are probed: those that seem to stand, and of which nothing has been seen for long. In: the field, the
// choices, the time. Out: places, the most suspect first.
#pragma once

#include <vector>

#include "server/sampling/field/price.h"

namespace framelet {

struct ProbeScratch {
    std::vector<std::uint8_t> active; ///< of the places: whether it moves
    std::vector<double> suspicions; ///< of the places: how long nothing was seen, seconds, times more beside what moves
};

/// Replaces `probed` by at most so many places, the neighbours of what moves first.
void select_probed(PlaceField const& field, Choices const& choices, double now, std::size_t most, ProbeScratch& scratch,
                   std::vector<std::uint32_t>& probed);

} // namespace framelet
