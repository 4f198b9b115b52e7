// Choices of a rival that depend on scene and machine: all are tried, and the best one counts, as if the rival had
// known it.
#pragma once

#include <string_view>
#include <vector>

#include "tests/evaluation/method.h"

namespace framelet::bench {

/// All choices to try: every spacing and margin where the method knows them and `parts` leaves them open. At least one,
/// with nothing left open.
std::vector<RivalParts> rival_choices(std::string_view method, RivalParts const& parts);

/// Index of the least of `errors`, which must not be empty; of equal ones the first.
std::size_t best_choice(std::vector<double> const& errors);

} // namespace framelet::bench
