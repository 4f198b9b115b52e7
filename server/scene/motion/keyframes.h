// One animation channel at one time (glTF 2.0 appendix C).
// In: a channel, seconds. Out: its value: three, four (unit quaternion, xyzw) or as many floats as morph targets.
#pragma once

#include <span>

#include "server/scene/scene.h"

namespace framelet {

/// Before the first key and after the last the value is that key's. `out` has `channel.components` floats.
void sample_channel(AnimationChannel const& channel, float seconds, std::span<float> out);

} // namespace framelet
