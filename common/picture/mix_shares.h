// Finds how far each block of a picture has got from what it showed before to what it shows next. In: scene times of
// both, the time that is shown. Out: how much of the second one to mix in.
#pragma once

#include <optional>
#include <vector>

#include "common/held/shown_times.h"
#include "common/picture/picture_mix.h"

namespace framelet {

/// Says how far a block has got at the time `shown` from content of `older` to content of `newer`: 0 at the older time,
/// 1 at the newer one, linear between them and clamped beyond, whichever way the clock runs. A change takes no longer
/// than `longest` seconds of scene time, the last ones before the newer content. The result is 1 where either time is
/// missing, and nothing where both are the same.
std::optional<double> mix_amount(std::optional<SceneTime> older, std::optional<SceneTime> newer, SceneTime shown,
                                 SceneTime longest);

/// Finds `mix_amount` for every block (in rows of `columns`; as many of each). A block whose times are the same can
/// change only by what has moved in from beside: it gets the mean of those blocks around it that do change, else of all
/// that do, else `whole_share`.
void mix_shares(ShownTimes const& older, ShownTimes const& newer, int columns, SceneTime shown, SceneTime longest,
                std::vector<MixShare>& shares);

} // namespace framelet
