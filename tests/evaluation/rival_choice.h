// The rivals' choices that depend on scene and machine: all are tried, and the best is theirs, as if they had known.
#pragma once

#include <string_view>
#include <vector>

#include "tests/evaluation/method.h"

namespace framelet::bench {

/// What there is to try: all spacings and margins where the method knows them and `parts` leaves them open. At least
/// one, with nothing left open.
std::vector<RivalParts> rival_choices(std::string_view method, RivalParts const& parts);

/// The index of the least of `errors`, which are not empty; of equal ones the first.
std::size_t best_choice(std::vector<double> const& errors);

} // namespace framelet::bench
