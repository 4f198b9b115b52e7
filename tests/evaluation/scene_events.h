// Events in the scenes of the project's generator. In: a scene's document. Out: when something jumps or comes to rest,
// when something moves, and which part of a scene a short run should see.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "scenes/gltf/gltf_document.h"

namespace framelet::bench {

/// Events of one scene; times are scene time, seconds.
struct SceneEvents {
    std::vector<double> times; ///< a jump, or all that moved stands from then on; in (0, duration), ascending
    std::vector<std::pair<double, double>> motions; ///< smooth motions, from and until
};

SceneEvents events_of(GltfDocument const& document, double duration);
/// Events of the generator's scene of that name. Throws InputError where it has none.
SceneEvents events_of(std::string const& name);

/// The scene's clock is set, which nobody knows of before.
struct ClockSetting {
    double when = 0; ///< seconds of the run
    double time = 0; ///< scene time then, seconds
};

/// How many of the settings, which are in order of time, have been made by `when`, seconds of the run.
std::size_t settings_made(std::vector<ClockSetting> const& settings, double when);

/// What the clock says at `now`, seconds of a run that begins at scene time `start`, to one who hears of each setting
/// `late` seconds after it.
double clock_at(std::vector<ClockSetting> const& settings, double start, double now, double late = 0);

/// Settings for a run of `seconds`, two a second. In `flicker` and `teleport` each is to where the scene is otherwise
/// and then rests for longer than until the next one: no track tells of any change. Elsewhere they are to times here
/// and there, `duration` is that of the animation: all that moves is somewhere else at once.
std::vector<ClockSetting> unannounced_settings(std::string const& name, double duration, double seconds);

/// Scene time at which a run of `seconds` should begin to see most of what the scene is for: the run is centred on a
/// vehicle's passing, else on the first event, else on the middle of the animation. 0 for a scene that is not the
/// generator's.
double window_start(std::string const& name, double seconds);

} // namespace framelet::bench
