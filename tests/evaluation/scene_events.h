// What happens when in the scenes of the project's generator. In: a scene's document. Out: when something jumps or
// comes to rest, when something moves, and which part of a scene a short run should see.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "scenes/gltf/gltf_document.h"

namespace framelet::bench {

/// Times are seconds of the scene's.
struct SceneEvents {
    std::vector<double> times; ///< something jumps, or all that moved stands from then on; in (0, duration), ascending
    std::vector<std::pair<double, double>> motions; ///< from, until: something moves smoothly
};

SceneEvents events_of(GltfDocument const& document, double duration);
/// Of the generator's scene of that name. InputError where it has none.
SceneEvents events_of(std::string const& name);

enum class Phase { moving, event, settled };

/// An event lasts for this long.
inline constexpr double event_seconds = 0.25;

/// `event` goes before `moving`.
Phase phase_at(SceneEvents const& events, double time);

/// From when on a run of so many seconds sees most of what the scene is for: around its first event, where a vehicle
/// passes, else in the middle. 0 for a scene that is not the generator's.
double window_start(std::string const& name, double seconds);

} // namespace framelet::bench
