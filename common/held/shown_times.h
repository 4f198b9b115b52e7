// Finds from which scene time each block of a picture shows something. In: the cache, which of its blocks changed.
// Out: scene times.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "common/held/framelet_cache.h"

namespace framelet {

/// The mean scene time of the framelets that each block of 16x16 pixels shows when nothing is moved, in rows; nothing
/// where none shows.
using ShownTimes = std::vector<std::optional<SceneTime>>;

/// Brings `times` up to date with `changed` (as `FrameletCache::take_changed` gives it). Where `times` has not as many
/// blocks as the cache's picture, it is made anew as a whole.
void update_shown_times(FrameletCache const& cache, std::span<PixelRect const> changed, ShownTimes& times);

/// Gives each block the time of the latest of the cache's framelets that lie in it, where that is later than its own.
void add_later_times(FrameletCache const& cache, ShownTimes& times);

} // namespace framelet
