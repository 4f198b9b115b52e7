// When a scene changes at once: a lamp goes on, the camera cuts, a clip begins again where it did not end.
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

    bool operator==(SceneSwitch const&) const = default;
};

/// Where one clip, which loops, jumps.
struct ClipSwitches {
    double duration = 0; ///< seconds, > 0
    std::vector<SceneSwitch> switches; ///< by their seconds into the clip, ascending, [0, duration)
};

/// Of those clips that jump anywhere: where a channel of steps takes another value, and where the clip's end is not
/// its beginning.
std::vector<ClipSwitches> find_switches(Scene const& scene, std::span<Index const> clips);

/// The one in (from, to], by its scene time; nothing where there is none or several: what jumps all the time is motion.
/// What is less than a millisecond apart is one jump, at the first of its times.
std::optional<SceneSwitch> lone_switch(std::span<ClipSwitches const> clips, SceneTime from, SceneTime to);

} // namespace framelet
