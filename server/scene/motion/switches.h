// Finds when a scene changes at once: a lamp goes on, the camera cuts, a clip begins again where it did not end.
// In: clips. Out: scene times.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "common/framelet/framelet.h"
#include "server/scene/scene.h"

namespace framelet {

struct SceneSwitch {
    SceneTime time = 0; ///< seconds
    bool is_seen = true; ///< something drawn or a light jumps, and not cameras alone
    SceneTime settling = 0; ///< seconds from `time` until all is as it stays

    bool operator==(SceneSwitch const&) const = default;
};

/// The times at which one clip, which loops, jumps.
struct ClipSwitches {
    double duration = 0; ///< seconds, > 0
    std::vector<SceneSwitch> switches; ///< by their seconds into the clip, ascending, [0, duration)
};

/// The jumps of those clips that have any: where a channel of steps takes another value, where the clip's end is not
/// its beginning, and where lights and cameras go from one place to another within a frame and stay at both. Exporters
/// that sample each frame write jumps so; the jump is in the middle then.
std::vector<ClipSwitches> find_switches(Scene const& scene, std::span<Index const> clips);

/// What jumps within a time. Jumps less than a millisecond apart are one, at the first of their times.
struct Switches {
    bool any = false;
    std::optional<SceneSwitch> lone; ///< the only one, at its scene time; what jumps all the time is motion
};

/// The jumps in (from, to].
Switches switches_within(std::span<ClipSwitches const> clips, SceneTime from, SceneTime to);

} // namespace framelet
