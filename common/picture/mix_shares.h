// How far each block of a picture has got from what it showed before to what it shows next. In: scene times of both,
// the time that is shown. Out: how much of the second one to mix in.
#pragma once

#include <optional>
#include <vector>

#include "common/held/shown_times.h"
#include "common/picture/picture_mix.h"

namespace framelet {

/// At `shown`, between content of `older` and of `newer`: 0 at the older time, 1 at the newer one, linear between them
/// and clamped beyond, whichever way the clock runs. A change takes no longer than `longest` seconds of scene time, the
/// last ones before the newer content. 1 where nothing is older; nothing where both are the same.
std::optional<double> mix_amount(std::optional<SceneTime> older, std::optional<SceneTime> newer, SceneTime shown,
                                 SceneTime longest);

/// `mix_amount` of every block (in rows of `columns`; as many of each). Where both are the same, only what has moved in
/// from beside can differ: the mean of those blocks around it that do change, else of all that do, else the whole.
void mix_shares(ShownTimes const& older, ShownTimes const& newer, int columns, SceneTime shown, SceneTime longest,
                std::vector<MixShare>& shares);

} // namespace framelet
