// The scene times from which the content of each block of a picture is. In: the cache, which of its blocks changed.
// Out: scene times.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "common/held/framelet_cache.h"

namespace framelet {

/// For each block of 16x16 pixels, in rows: the mean scene time of the framelets that show there when nothing is moved;
/// nothing where none does.
using ShownTimes = std::vector<std::optional<SceneTime>>;

/// Brings `times` up to date with `changed` (as `FrameletCache::take_changed` gives it). Where it is of another size
/// than the cache's it is made anew as a whole.
void update_shown_times(FrameletCache const& cache, std::span<PixelRect const> changed, ShownTimes& times);

/// Gives each block the time of the latest of the cache's framelets that lie in it, where that is later than its own.
void add_later_times(FrameletCache const& cache, ShownTimes& times);

} // namespace framelet
