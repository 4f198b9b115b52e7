// From when the content of each block of a picture is. In: the cache, which of its blocks changed. Out: scene times.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "common/held/framelet_cache.h"

namespace framelet {

/// Of blocks of 16x16 pixels in rows: the mean scene time of the framelets that show there when nothing is moved;
/// nothing where none does.
using ShownTimes = std::vector<std::optional<SceneTime>>;

/// Brings `times` up to date with `changed` (as `FrameletCache::take_changed` gives it). Of another size than the
/// cache's, it is made anew as a whole.
void update_shown_times(FrameletCache const& cache, std::span<PixelRect const> changed, ShownTimes& times);

/// Blocks in which a framelet of the cache lies that is later than their time get its time.
void add_later_times(FrameletCache const& cache, ShownTimes& times);

} // namespace framelet
