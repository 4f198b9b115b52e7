// Evaluates one animation channel at one time (glTF 2.0 appendix C).
// In: a channel, seconds. Out: its value: three, four (unit quaternion, xyzw) or as many floats as morph targets.
#pragma once

#include <span>

#include "server/scene/scene.h"

namespace framelet {

/// Sets `out` (`channel.components` floats) to the value; before the first key and after the last it is that key's.
void sample_channel(AnimationChannel const& channel, float seconds, std::span<float> out);

} // namespace framelet
